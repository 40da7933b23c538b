// The samples' files, painted once: a job of a sample begins with copies.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "base/context.h"

namespace hydrodip {

class SampleShelf {
 public:
  // `folder` is made when there is something to keep. What another build of the program left there
  // is made anew.
  explicit SampleShelf(const std::filesystem::path& folder);

  // Copies the sample's files into a folder that is there; its model's name. Throws InputError:
  // there is no such sample, or no room.
  std::string place(const std::string& name, const std::filesystem::path& to);

  // Makes what is not there yet. Ends early, and quietly, when cancelled or when there is no room.
  void fill(const RunContext& context);

 private:
  // Where they lie, once they do.
  std::filesystem::path ready(const std::string& name);

  const std::filesystem::path folder_;  // of this build alone
  std::mutex mutex_;                    // one paints at a time
};

}  // namespace hydrodip
