#include "base/output_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace hydrodip {

namespace fs = std::filesystem;

namespace {

// Inside the staging folder: what the final names held before, until all of them are replaced.
// Not a name that a caller can ask for, see path().
constexpr const char* kEarlierFolder = "..earlier";

[[noreturn]] void refuse_folder(const fs::path& folder, const std::error_code& why) {
  throw InputError(fmt::format(
      "{}: the output folder cannot be created or written to ({}); choose another one with -o.",
      folder.string(), why.message()));
}

[[noreturn]] void refuse_file(const fs::path& file, const std::string& why) {
  throw InputError(
      fmt::format("{}: cannot be written ({}); free the name or choose another output folder.",
                  file.string(), why));
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

bool make_staging_folder(const fs::path& folder, fs::path& staging) {
  std::string name = (folder / ".hydrodip-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) return false;
  staging = name;
  return true;
}

// Puts finished files under their final names one by one; undo() brings everything back.
class Replacement {
 public:
  Replacement(const fs::path& staging, const fs::path& folder)
      : staging_(staging), folder_(folder), earlier_(staging / kEarlierFolder) {}

  std::error_code replace(const std::string& name) {
    std::error_code error;
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
      }
    }
    done_.clear();
  }

 private:
  // A second link keeps the final name filled at every moment; where the file system has no links,
  // the earlier file is moved aside.
  std::error_code keep_earlier(const std::string& name) {
    std::error_code error;
    fs::create_directory(earlier_, error);
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

OutputFolder::OutputFolder(const fs::path& folder) : folder_(folder.empty() ? "." : folder) {
  const std::vector<fs::path> missing = missing_folders(folder_);
  std::error_code error;
  for (auto it = missing.rbegin(); it != missing.rend() && !error; ++it) {
    if (fs::create_directory(*it, error)) created_.push_back(*it);
  }
  if (!error && !make_staging_folder(folder_, staging_)) error = {errno, std::generic_category()};
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

fs::path OutputFolder::path(const std::string& name) {
  if (staging_.empty()) throw std::logic_error("OutputFolder::path() after commit()");
  if (name.empty() || name.starts_with("..") || name == "." ||
      name.find('/') != std::string::npos) {
    throw std::logic_error("OutputFolder::path(): not a plain file name: '" + name + "'");
  }
  if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
  return staging_ / name;
}

void OutputFolder::commit() {
  std::error_code error;
  for (const std::string& name : names_) {
    if (!fs::is_regular_file(staging_ / name, error)) {
      refuse_file(folder_ / name, "it was not finished");
    }
    if (fs::is_directory(folder_ / name, error)) {
      refuse_file(folder_ / name, "a folder of that name is in the way");
    }
  }
  Replacement replacement(staging_, folder_);
  for (const std::string& name : names_) {
    error = replacement.replace(name);
    if (error) {
      replacement.undo();
      refuse_file(folder_ / name, error.message());
    }
  }
  names_.clear();
  created_.clear();
  fs::remove_all(staging_, error);
  staging_.clear();
}

}  // namespace hydrodip
