// A folder that one holder has at a time, in this process or another.
#pragma once

#include "base/file_lock.h"

namespace hydrodip {

class FolderLock : public FileLock {
 public:
  FolderLock() = default;
  explicit FolderLock(const std::filesystem::path& folder);
  // Waits for whoever has it, which has to take no more than milliseconds.
  static FolderLock waited_for(const std::filesystem::path& folder);

 private:
  FolderLock(const std::filesystem::path& folder, bool waits);
};

}  // namespace hydrodip
