#include "calibrate/store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kNumbers = 11;  // of a corner: place, position, slopes

std::string line_of(const SimulationKey& key, const SimulationResult& result) {
  Json line = {{"subject", key.subject},
               {"z_stretch", key.parameters.z_stretch},
               {"ink_stiffness_ratio", key.parameters.stiffness_ratio},
               {"poisson", key.parameters.poisson},
               {"reach", nullptr},
               {"corners", nullptr}};
  if (result) {
    line["reach"] = result->reach;
    Json corners = Json::array();
    for (int row = -result->reach[1]; row <= result->reach[1]; ++row)
      for (int column = -result->reach[0]; column <= result->reach[0]; ++column) {
        const Landing* landing = result->find({column, row});
        if (landing == nullptr) continue;
        Json corner = {column, row};
        for (const double x : landing->position) corner.push_back(x);
        for (const double slope : landing->by_film.reshaped()) corner.push_back(slope);
        corners.push_back(corner);
      }
    line["corners"] = corners;
  }
  return line.dump() + "\n";
}

bool parse_landings(const Json& line, Landings& landings) {
  constexpr int kMostReach = 100000;
  const Json &reach = line["reach"], &corners = line["corners"];
  if (!reach.is_array() || reach.size() != 2 || !corners.is_array()) return false;
  double squares = 1;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!reach[k].is_number_integer()) return false;
    const auto value = reach[k].get<std::int64_t>();
    if (value < 0 || value > kMostReach) return false;
    landings.reach[k] = int(value);
    squares *= double(2 * value + 1);
  }
  constexpr double kMostCorners = 1e6;
  if (squares > kMostCorners) return false;
  landings.corner.resize(std::size_t(squares));
  for (const Json& numbers : corners) {
    if (!numbers.is_array() || numbers.size() != kNumbers) return false;
    for (const Json& number : numbers)
      if (!number.is_number()) return false;
    if (!numbers[0].is_number_integer() || !numbers[1].is_number_integer()) return false;
    const auto column = numbers[0].get<std::int64_t>(), row = numbers[1].get<std::int64_t>();
    if (std::abs(column) > landings.reach[0] || std::abs(row) > landings.reach[1]) return false;
    Landing landing;
    for (int k = 0; k < 3; ++k) landing.position[k] = numbers[std::size_t(2 + k)];
    for (int k = 0; k < 6; ++k) landing.by_film(k % 3, k / 3) = numbers[std::size_t(5 + k)];
    landings.corner[landings.index_of({int(column), int(row)})] = landing;
  }
  return true;
}

enum class Line { kDamaged, kOld, kGood };

// Lines of programs that kept where each scan's corners lie on the film are no use any more.
Line parse_line(const std::string& text, SimulationKey& key, SimulationResult& result) {
  const Json line = parsed_json<Json>(text);
  if (!line.is_object()) return Line::kDamaged;
  for (const char* name : {"z_stretch", "ink_stiffness_ratio", "poisson"})
    if (!line.contains(name) || !line[name].is_number()) return Line::kDamaged;
  if (!line.contains("subject") || !line["subject"].is_string()) return Line::kDamaged;
  key.subject = line["subject"];
  key.parameters = {line["z_stretch"], line["ink_stiffness_ratio"], line["poisson"]};
  if (line.contains("film_mm")) return Line::kOld;
  if (!line.contains("reach") || !line.contains("corners")) return Line::kDamaged;
  result.reset();
  if (line["corners"].is_null()) return Line::kGood;
  return parse_landings(line, result.emplace()) ? Line::kGood : Line::kDamaged;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.string(), why));
}

}  // namespace

bool SimulationKey::operator<(const SimulationKey& other) const {
  const auto tie = [](const SimulationKey& key) {
    return std::tie(key.subject, key.parameters.z_stretch, key.parameters.stiffness_ratio,
                    key.parameters.poisson);
  };
  return tie(*this) < tie(other);
}

SimulationStore::SimulationStore(const std::filesystem::path& file,
                                 const std::vector<std::filesystem::path>& others)
    : file_(file) {
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(file, ignored);
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0)
    refuse(file,
           fmt::format("the store of simulations cannot be opened ({})", std::strerror(errno)));
  lock_ = FileLock(descriptor, file);
  if (lock_.state() == FileLock::State::kTaken)
    refuse(file, "another calibration is writing to it; wait for it, or choose another folder");
  if (lock_.state() == FileLock::State::kGone)
    refuse(file, "it was removed just now; calibrate again");
  made_ = is_new && lock_.state() == FileLock::State::kHeld;
  try {
    drop_torn_line();
    read(file);
    for (const auto& other : others) read(other);
  } catch (...) {
    remove_if_made_for_nothing();
    throw;
  }
}

SimulationStore::~SimulationStore() { remove_if_made_for_nothing(); }

void SimulationStore::remove_if_made_for_nothing() const {
  std::error_code ignored;
  if (made_ && std::filesystem::file_size(file_, ignored) == 0)
    std::filesystem::remove(file_, ignored);
}

void SimulationStore::drop_torn_line() {
  const std::vector<std::uint8_t> bytes = read_file(file_);
  std::size_t whole = bytes.size();
  while (whole > 0 && bytes[whole - 1] != '\n') --whole;
  if (whole < bytes.size() && ::ftruncate(lock_.descriptor(), off_t(whole)) != 0)
    refuse(file_, fmt::format("cannot be written ({})", std::strerror(errno)));
}

void SimulationStore::read(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_file(file);
  const std::string text(bytes.begin(), bytes.end());
  std::size_t number = 0;
  read_.push_back({file, {}, {}});
  FileRead& about = read_.back();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;  // of another process, still being written
    ++number;
    SimulationKey key;
    SimulationResult result;
    const Line kind = parse_line(text.substr(begin, end - begin), key, result);
    if (kind == Line::kGood) results_.try_emplace(key, result);
    if (kind == Line::kDamaged)
      about.damaged.push_back(number);
    else
      ++about.of_subject[key.subject];
    begin = end + 1;
  }
  if (about.of_subject.empty() && !about.damaged.empty())
    refuse(file, fmt::format("line {} is no result of a simulation; is this a store that "
                             "'hydrodip calibrate' wrote?",
                             about.damaged.front()));
}

std::vector<std::string> SimulationStore::oddities(const std::vector<std::string>& subjects) const {
  std::vector<std::string> sentences;
  if (lock_.state() == FileLock::State::kNone)
    sentences.push_back(
        fmt::format("{}: its file system has no locks; see that no other calibration writes to it.",
                    file_.string()));
  for (const FileRead& about : read_) {
    if (!about.damaged.empty())
      sentences.push_back(fmt::format(
          "{}: {} damaged ({} {}); what stood there is simulated again.", about.file.string(),
          about.damaged.size() == 1 ? "a line is"
                                    : fmt::format("{} lines are", about.damaged.size()),
          about.damaged.size() == 1 ? "line" : "first: line", about.damaged.front()));
    std::size_t all = 0, foreign = 0;
    for (const auto& [subject, count] : about.of_subject) {
      all += count;
      const bool ours = std::any_of(
          subjects.begin(), subjects.end(),
          [&, &of = subject](const std::string& known) { return of.starts_with(known); });
      if (!ours) foreign += count;
    }
    if (foreign > 0 && about.file != file_)
      sentences.push_back(fmt::format(
          "{}: {} of its {} simulations are not used: they are of other objects, another "
          "board or other settings (film.elements, dip.step_mm, ...) than this calibration's, or "
          "of an "
          "older program.",
          about.file.string(), foreign, all));
  }
  return sentences;
}

const SimulationResult* SimulationStore::find(const SimulationKey& key) const {
  const auto found = results_.find(key);
  return found == results_.end() ? nullptr : &found->second;
}

void SimulationStore::add(const SimulationKey& key, const SimulationResult& result) {
  const std::string line = line_of(key, result);
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = ::write(lock_.descriptor(), line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int error = errno;
      drop_torn_line();
      refuse(file_, fmt::format("a result cannot be kept ({}); free space and run it again",
                                std::strerror(error)));
    }
    written += std::size_t(count);
  }
  ::fdatasync(lock_.descriptor());
  results_.try_emplace(key, result);
}

}  // namespace hydrodip
