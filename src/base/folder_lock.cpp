#include "base/folder_lock.h"

#include <fcntl.h>

namespace hydrodip {

FolderLock::FolderLock(const std::filesystem::path& folder) : FolderLock(folder, false) {}

FolderLock FolderLock::waited_for(const std::filesystem::path& folder) {
  return FolderLock(folder, true);
}

FolderLock::FolderLock(const std::filesystem::path& folder, bool waits)
    : FileLock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder, waits) {}

}  // namespace hydrodip
