#include "base/output_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/json_nesting.h"
#include "base/obstacle.h"
#include "base/staging_name.h"

namespace hydrodip {

namespace fs = std::filesystem;

namespace {

// Inside the staging folder: what the final names held before, until all of them are replaced.
// Not a name that a caller can ask for, see path().
constexpr const char* kEarlierFolder = "..earlier";

[[noreturn]] void refuse_folder(const fs::path& folder, const std::error_code& why) {
  throw InputError(fmt::format(
      "{}: the output folder cannot be created or written to ({}); write to another one.",
      folder.string(), why.message()));
}

[[noreturn]] void refuse_file(const fs::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: cannot be written ({}); free the name, or write elsewhere.",
                               file.string(), why));
}

[[noreturn]] void refuse_to_replace(const fs::path& file) {
  throw InputError(
      fmt::format("{}: there is such a file already, and no_clobber keeps it; write to another "
                  "folder, or leave out --no-clobber (output.no_clobber).",
                  file.string()));
}

void require_free_name(const fs::path& file) {
  const std::string obstacle = obstacle_at(file);
  if (!obstacle.empty()) refuse_file(file, obstacle + " of that name is in the way");
}

// The folder and its missing ancestors, outermost last.
std::vector<fs::path> missing_folders(fs::path folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  while (!folder.empty() && !fs::exists(folder, ignored)) {
    missing.push_back(folder);
    const fs::path parent = folder.parent_path();
    if (parent == folder) break;
    folder = parent;
  }
  return missing;
}

void remove_created(std::vector<fs::path>& created) {
  std::error_code ignored;
  // Only empty folders go: whatever somebody else put there meanwhile stays.
  while (!created.empty()) {
    fs::remove(created.back(), ignored);
    created.pop_back();
  }
}

// A staging folder that nobody has locked was left by a process that was killed.
void clear_abandoned(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> found;
  for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end;
       it.increment(ignored)) {
    if (is_staging_name(it->path().filename().string()) &&
        fs::is_directory(it->symlink_status(ignored)))
      found.push_back(it->path());
  }
  for (const fs::path& staging : found) {
    const FolderLock lock(staging);
    if (lock.state() == FolderLock::State::kHeld) fs::remove_all(staging, ignored);
  }
}

bool make_staging_folder(const fs::path& folder, fs::path& staging, FolderLock& lock) {
  for (int tries = 0; tries < 10; ++tries) {
    std::string name = (folder / fmt::format("{}{}", kStagingPrefix, kStagingLetters)).string();
    if (mkdtemp(name.data()) == nullptr) return false;
    staging = name;
    lock = FolderLock(staging);
    if (lock.state() == FolderLock::State::kHeld || lock.state() == FolderLock::State::kNone)
      return true;
  }
  return true;
}

// Most of what hydrodip writes has its name in it, near one end; JSON results say their command.
bool names_hydrodip(const fs::path& file) {
  constexpr std::streamoff kPart = 1 << 16;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;  // a pipe would be waited for
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(std::size_t(kPart), '\0');
  const auto part_speaks = [&](std::streamoff from) {
    stream.clear();
    stream.seekg(from);
    stream.read(bytes.data(), kPart);
    const auto read = std::size_t(std::max<std::streamsize>(stream.gcount(), 0));
    const std::string_view part = std::string_view(bytes).substr(0, read);
    return part.find("hydrodip") != std::string_view::npos ||
           part.find("\n  \"command\": \"") != std::string_view::npos;
  };
  const auto size = std::streamoff(fs::file_size(file, error));
  return !error && (part_speaks(0) || part_speaks(std::max<std::streamoff>(size - kPart, 0)));
}

// Names that an earlier result's report in the folder says it wrote there. Nothing: there is none
// that says so.
std::optional<std::set<std::string>> names_in_report(const fs::path& folder) {
  constexpr std::uintmax_t kLargest = 64 << 20;
  const fs::path report = folder / "report.json";
  std::error_code error;
  if (!fs::is_regular_file(report, error) || fs::file_size(report, error) > kLargest) return {};
  std::ifstream stream(report, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const auto json = parsed_json<nlohmann::json>(bytes);
  if (!json.is_object() || !json.contains("command") || !json.contains("outputs") ||
      !json["outputs"].is_array())
    return {};
  std::set<std::string> names;
  for (const auto& output : json["outputs"])
    if (output.is_object() && output.contains("name") && output["name"].is_string())
      names.insert(output["name"].get<std::string>());
  return names;
}

// What is known of who wrote the files of a folder, and of the folders in it.
class Authorship {
 public:
  explicit Authorship(const fs::path& folder) : folder_(folder) {}

  // Whether hydrodip wrote the file: it says so itself, as pictures and tables do not; or, of
  // `names` that make up a job with its report, the report that is there says so; or another of
  // `names` beside it speaks of hydrodip.
  bool is_ours(const std::string& name, const std::vector<std::string>& names) {
    if (names_hydrodip(folder_ / name)) return true;
    const fs::path within = fs::path(name).parent_path();
    const auto [known, is_new] = reported_.try_emplace(within.string());
    const bool is_job =
        std::find(names.begin(), names.end(), (within / "report.json").string()) != names.end();
    if (is_new && is_job) known->second = names_in_report(folder_ / within);
    if (known->second) return known->second->contains(fs::path(name).filename().string());
    return std::any_of(names.begin(), names.end(), [&](const std::string& other) {
      return fs::path(other).parent_path() == within && names_hydrodip(folder_ / other);
    });
  }

 private:
  fs::path folder_;
  std::map<std::string, std::optional<std::set<std::string>>> reported_;
};

// Puts finished files under their final names one by one; undo() brings everything back.
class Replacement {
 public:
  Replacement(const fs::path& staging, const fs::path& folder)
      : staging_(staging), folder_(folder), earlier_(staging / kEarlierFolder) {}

  std::error_code replace(const std::string& name) {
    std::error_code error;
    fs::create_directories((folder_ / name).parent_path(), error);
    if (error) return error;
    const bool had_earlier = fs::exists(fs::symlink_status(folder_ / name, error));
    error.clear();
    if (had_earlier) error = keep_earlier(name);
    if (error) return error;
    done_.emplace_back(name, had_earlier);
    fs::rename(staging_ / name, folder_ / name, error);
    return error;
  }

  void undo() {
    std::error_code ignored;
    for (auto it = done_.rbegin(); it != done_.rend(); ++it) {
      const auto& [name, had_earlier] = *it;
      if (had_earlier) {
        fs::rename(earlier_ / name, folder_ / name, ignored);
      } else {
        fs::remove(folder_ / name, ignored);
        // A folder that was made for it; one that holds anything else stays.
        if ((folder_ / name).parent_path() != folder_)
          fs::remove((folder_ / name).parent_path(), ignored);
      }
    }
    done_.clear();
  }

 private:
  // A second link keeps the final name filled at every moment; where the file system has no links,
  // the earlier file is moved aside.
  std::error_code keep_earlier(const std::string& name) {
    std::error_code error;
    fs::create_directories((earlier_ / name).parent_path(), error);
    if (error) return error;
    fs::create_hard_link(folder_ / name, earlier_ / name, error);
    if (error) {
      error.clear();
      fs::rename(folder_ / name, earlier_ / name, error);
    }
    return error;
  }

  fs::path staging_, folder_, earlier_;
  std::vector<std::pair<std::string, bool>> done_;
};

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, EarlierResult earlier)
    : folder_(folder.empty() ? "." : folder), earlier_(earlier) {
  const std::vector<fs::path> missing = missing_folders(folder_);
  std::error_code error;
  for (auto it = missing.rbegin(); it != missing.rend() && !error; ++it) {
    if (fs::create_directory(*it, error)) created_.push_back(*it);
  }
  if (!error) clear_abandoned(folder_);
  if (!error && !make_staging_folder(folder_, staging_, lock_))
    error = {errno, std::generic_category()};
  if (error) {
    remove_created(created_);
    refuse_folder(folder_, error);
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  remove_created(created_);
}

void OutputFolder::announce(const std::vector<std::string>& names,
                            const std::vector<fs::path>& inputs) {
  inputs_ = inputs;
  std::error_code ignored;
  Authorship authorship(folder_);
  for (const std::string& name : names) {
    const fs::path file = folder_ / name;
    if (!fs::exists(file, ignored)) continue;
    if (const fs::path* input = input_at(file))
      throw InputError(
          fmt::format("{}: the job reads this file, and its result {} would overwrite it; move it "
                      "elsewhere, or write to another folder.",
                      input->string(), name));
    require_free_name(file);
    if (earlier_ == EarlierResult::kKept) refuse_to_replace(file);
    if (!authorship.is_ours(name, names))
      throw InputError(
          fmt::format("{}: this file was not written by hydrodip, and would be replaced; move it "
                      "away, or write to another folder.",
                      file.string()));
  }
}

fs::path OutputFolder::path(const std::string& name) {
  if (staging_.empty()) throw std::logic_error("OutputFolder::path() after commit()");
  const fs::path parts(name);
  const bool is_plain = parts.is_relative() && parts.has_filename() &&
                        std::none_of(parts.begin(), parts.end(), [](const fs::path& part) {
                          return part == "." || part.string().starts_with("..");
                        });
  if (!is_plain)
    throw std::logic_error("OutputFolder::path(): not a plain file name: '" + name + "'");
  std::error_code error;
  fs::create_directories((staging_ / parts).parent_path(), error);
  if (error) refuse_file(folder_ / parts, error.message());
  if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
  return staging_ / name;
}

const fs::path* OutputFolder::input_at(const fs::path& file) const {
  std::error_code ignored;
  const auto at = std::find_if(inputs_.begin(), inputs_.end(), [&](const fs::path& input) {
    return fs::equivalent(file, input, ignored);
  });
  return at == inputs_.end() ? nullptr : &*at;
}

void OutputFolder::remove_superseded() const {
  std::error_code ignored;
  for (const std::string& name : superseded_) {
    fs::remove(folder_ / name, ignored);
    if (const fs::path within = fs::path(name).parent_path(); !within.empty())
      fs::remove(folder_ / within, ignored);  // if empty
  }
}

void OutputFolder::commit() {
  std::error_code error;
  for (const std::string& name : names_) {
    if (!fs::is_regular_file(staging_ / name, error)) {
      refuse_file(folder_ / name, "it was not finished");
    }
    require_free_name(folder_ / name);
    // Another job may have come first.
    if (earlier_ == EarlierResult::kKept && fs::exists(folder_ / name, error))
      refuse_to_replace(folder_ / name);
  }
  // The earlier report, which is about to go, knows what was written.
  Authorship authorship(folder_);
  std::vector<std::string> all = names_;
  all.insert(all.end(), superseded_.begin(), superseded_.end());
  std::erase_if(superseded_, [&](const std::string& name) {
    const bool is_new = std::find(names_.begin(), names_.end(), name) != names_.end();
    return is_new || !fs::is_regular_file(folder_ / name, error) ||
           input_at(folder_ / name) != nullptr || !authorship.is_ours(name, all);
  });
  Replacement replacement(staging_, folder_);
  for (const std::string& name : names_) {
    std::error_code ignored;
    replaced_earlier_ = replaced_earlier_ || fs::exists(folder_ / name, ignored);
    error = replacement.replace(name);
    if (error) {
      replacement.undo();
      refuse_file(folder_ / name, error.message());
    }
  }
  remove_superseded();
  names_.clear();
  created_.clear();
  fs::remove_all(staging_, error);
  staging_.clear();
}

std::string OutputFolder::told_replaced() const {
  if (!replaced_earlier_ && superseded_.empty()) return {};
  return superseded_.empty() ? "replaced the earlier result there\n"
                             : fmt::format("replaced the earlier result there; gone with it: {}\n",
                                           fmt::join(superseded_, ", "));
}

}  // namespace hydrodip
