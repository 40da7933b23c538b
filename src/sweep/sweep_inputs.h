// The files that a sweep's runs read. A run is known by their content, so that no result is ever
// taken for one of other files.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "base/context.h"
#include "base/error.h"
#include "sweep/sweep_plan.h"

namespace hydrodip {

// A file as the plan has it: relative to the sweep's folder, or absolute where it cannot be.
std::string from_folder(const std::filesystem::path& file, const std::filesystem::path& folder);

// Of a run's id, which is a hash.
inline constexpr std::size_t kIdDigits = 16;

// Whether the setting's text is the name of a file.
bool names_file(const std::string& setting, const std::string& text);

// What a run reads is not what the sweep was planned with.
class ChangedInput : public InputError {
 public:
  using InputError::InputError;
};

// Hashes of files as they are now. One that has not been touched is read once.
class FileHashes {
 public:
  // SHA-256; "" if there is no such file, or it cannot be read.
  std::string of(const std::filesystem::path& file);

 private:
  struct Known {
    std::filesystem::file_time_type written;
    std::uintmax_t size = 0;
    std::string hash;
  };
  std::mutex mutex_;
  std::map<std::string, Known> known_;
};

// Notes in the plan which files the run reads, and what is in them; gives the run its id.
void note_inputs(SweepPlan& plan, SweepRun& run, const std::filesystem::path& folder,
                 FileHashes& hashes, const RunContext& context);

// Throws ChangedInput if a file that the run reads is not what it was when the sweep was planned,
// or if the run's id is not that of its values.
void require_unchanged(const SweepPlan& plan, const SweepRun& run,
                       const std::filesystem::path& folder, FileHashes& hashes);

// The same of what its report says that it has read.
void require_as_planned(const SweepPlan& plan, const std::string& report,
                        const std::filesystem::path& folder);

}  // namespace hydrodip
