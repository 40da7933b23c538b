// Where jobs live between runs of the studio: a folder for each, with its document as it was last
// (autosave), what was uploaded, and what was printed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/folder_lock.h"
#include "studio/json.h"

namespace hydrodip {

// "~/dips/mask.toml"
std::string shown_path(const std::filesystem::path& path);

// The person's own folder for such things; made if needed. Throws InputError.
std::filesystem::path studio_folder();

// In a job's folder: a picture for the list of recent jobs.
inline constexpr const char* kThumbnail = "thumbnail.png";

class JobStore {
 public:
  explicit JobStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // A new, empty job's name.
  std::string create() const;
  bool has(const std::string& job) const;
  // Its folder: files/ (uploads), print/, thumbnail.png.
  std::filesystem::path home(const std::string& job) const;

  // For the samples' files, beside the jobs.
  std::filesystem::path samples() const { return folder_ / "samples"; }

  // Null if it cannot be read, or is no job's.
  Json read(const std::string& job) const;
  void write(const std::string& job, const Json& state) const;
  // Of a job that its tabs have left. If nothing else has changed, it keeps its place among the
  // recent ones.
  void write_left(const std::string& job, const Json& state) const;

  // RECENT of docs/studio-api.md, latest first.
  Json recent(std::size_t most) const;
  // Which the studio that has it open holds: no other one may open or forget it meanwhile.
  FolderLock hold(const std::string& job) const { return FolderLock(home(job)); }
  // With all that was uploaded to it.
  void forget(const std::string& job) const;

  // The job that was opened last from that file, or saved to it; or "".
  std::string opened_from(const std::filesystem::path& file) const;

 private:
  std::vector<std::string> jobs() const;

  std::filesystem::path folder_;
};

}  // namespace hydrodip
