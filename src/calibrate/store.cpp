#include "calibrate/store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

std::string line_of(const SimulationKey& key, const SimulationResult& result) {
  Json line = {{"subject", key.subject},
               {"z_stretch", key.parameters.z_stretch},
               {"ink_stiffness_ratio", key.parameters.stiffness_ratio},
               {"poisson", key.parameters.poisson},
               {"film_mm", nullptr}};
  if (result) {
    Json corners = Json::array();
    for (const auto& corner : *result)
      corners.push_back(corner ? Json{corner->x(), corner->y()} : Json(nullptr));
    line["film_mm"] = corners;
  }
  return line.dump() + "\n";
}

// Whether the line is one of ours.
bool parse_line(const std::string& text, SimulationKey& key, SimulationResult& result) {
  const Json line = Json::parse(text, nullptr, false);
  if (!line.is_object()) return false;
  for (const char* name : {"z_stretch", "ink_stiffness_ratio", "poisson"})
    if (!line.contains(name) || !line[name].is_number()) return false;
  if (!line.contains("subject") || !line["subject"].is_string() || !line.contains("film_mm"))
    return false;
  key.subject = line["subject"];
  key.parameters = {line["z_stretch"], line["ink_stiffness_ratio"], line["poisson"]};
  const Json& corners = line["film_mm"];
  result.reset();
  if (corners.is_null()) return true;
  if (!corners.is_array()) return false;
  result.emplace();
  for (const Json& corner : corners) {
    const bool is_point =
        corner.is_array() && corner.size() == 2 && corner[0].is_number() && corner[1].is_number();
    if (!is_point && !corner.is_null()) return false;
    result->push_back(is_point ? std::optional<Vec2>(Vec2(corner[0], corner[1])) : std::nullopt);
  }
  return true;
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
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    refuse(file,
           fmt::format("the store of simulations cannot be opened ({})", std::strerror(errno)));
  try {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
      refuse(file, "another calibration is writing to it; wait for it, or choose another folder");
    drop_torn_line();
    read(file);
    for (const auto& other : others) read(other);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

SimulationStore::~SimulationStore() { ::close(descriptor_); }

void SimulationStore::drop_torn_line() {
  const std::vector<std::uint8_t> bytes = read_file(file_);
  std::size_t whole = bytes.size();
  while (whole > 0 && bytes[whole - 1] != '\n') --whole;
  if (whole < bytes.size() && ::ftruncate(descriptor_, off_t(whole)) != 0)
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
    if (parse_line(text.substr(begin, end - begin), key, result)) {
      results_.try_emplace(key, result);
      ++about.of_subject[key.subject];
    } else {
      about.damaged.push_back(number);
    }
    begin = end + 1;
  }
  if (about.of_subject.empty() && !about.damaged.empty())
    refuse(file, fmt::format("line {} is no result of a simulation; is this a store that "
                             "'hydrodip calibrate' wrote?",
                             about.damaged.front()));
}

std::vector<std::string> SimulationStore::oddities(const std::vector<std::string>& subjects) const {
  std::vector<std::string> sentences;
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
          "{}: {} of its {} simulations are not used: they are of other scans, other objects or "
          "other settings (film.elements, dip.step_mm, ...) than this calibration's.",
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
    const ssize_t count = ::write(descriptor_, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      refuse(file_, fmt::format("a result cannot be kept ({}); free space and run it again",
                                std::strerror(errno)));
    written += std::size_t(count);
  }
  ::fdatasync(descriptor_);
  results_.try_emplace(key, result);
}

}  // namespace hydrodip
