#include "base/file_lock.h"

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
bool is_still_there(int descriptor, const std::filesystem::path& named) {
  struct stat locked = {}, found = {};
  return ::fstat(descriptor, &locked) == 0 && ::stat(named.c_str(), &found) == 0 &&
         locked.st_ino == found.st_ino && locked.st_dev == found.st_dev;
}

}  // namespace

FileLock::FileLock(int descriptor, const std::filesystem::path& named, bool waits)
    : descriptor_(descriptor), state_(State::kGone) {
  if (descriptor_ < 0) return;
  const int error = lock(descriptor_, waits);
  if (error == EWOULDBLOCK)
    state_ = State::kTaken;
  else if (error != 0)
    state_ = State::kNone;
  else if (is_still_there(descriptor_, named))
    state_ = State::kHeld;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace hydrodip
