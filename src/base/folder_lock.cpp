#include "base/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace hydrodip {
namespace {

int lock(int descriptor, bool waits) {
  int done = 0;
  do done = ::flock(descriptor, LOCK_EX | (waits ? 0 : LOCK_NB));
  while (done != 0 && errno == EINTR);
  return done == 0 ? 0 : errno;
}

// Whoever had it may have removed it, and another may have made it anew.
bool is_still_there(int descriptor, const std::filesystem::path& folder) {
  struct stat locked = {}, named = {};
  return ::fstat(descriptor, &locked) == 0 && ::stat(folder.c_str(), &named) == 0 &&
         locked.st_ino == named.st_ino && locked.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : FolderLock(folder, false) {}

FolderLock FolderLock::waited_for(const std::filesystem::path& folder) {
  return FolderLock(folder, true);
}

FolderLock::FolderLock(const std::filesystem::path& folder, bool waits) {
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  state_ = State::kGone;
  if (descriptor_ < 0) return;
  const int error = lock(descriptor_, waits);
  if (error == 0 && is_still_there(descriptor_, folder)) {
    state_ = State::kHeld;
    return;
  }
  if (error == EWOULDBLOCK)
    state_ = State::kTaken;
  else if (error != 0)
    state_ = State::kNone;
  ::close(descriptor_);
  descriptor_ = -1;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace hydrodip
