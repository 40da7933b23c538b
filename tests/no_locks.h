// A file system without locks: what a program that includes this locks, while it wants none.
#pragma once

#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

namespace hydrodip {
namespace {

std::atomic<bool> nothing_locks = false;

// For as long as it lives.
struct NoLocks {
  NoLocks() { nothing_locks = true; }
  ~NoLocks() { nothing_locks = false; }
  NoLocks(const NoLocks&) = delete;
  NoLocks& operator=(const NoLocks&) = delete;
};

}  // namespace
}  // namespace hydrodip

// In the place of the system's.
extern "C" int flock(int descriptor, int operation) noexcept {
  if (!hydrodip::nothing_locks) return int(::syscall(SYS_flock, descriptor, operation));
  errno = ENOLCK;
  return -1;
}
