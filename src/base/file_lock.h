// A file or folder that one holder has at a time, in this process or another.
#pragma once

#include <filesystem>
#include <utility>

namespace hydrodip {

// The lock goes with the process, however that ends.
class FileLock {
 public:
  enum class State {
    kHeld,
    kTaken,  // by another holder
    kGone,   // there is no such file, or it was removed meanwhile
    kNone,   // nothing is locked here: the file system has no locks
  };

  FileLock() = default;
  // Of what is open there under that name; takes the descriptor over, which may be -1. Waits, if it
  // is to, for whoever has it, which has to take no more than milliseconds.
  FileLock(int descriptor, const std::filesystem::path& named, bool waits = false);
  ~FileLock();
  FileLock(FileLock&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), state_(other.state_) {}
  FileLock& operator=(FileLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(state_, other.state_);
    return *this;
  }

  State state() const { return state_; }
  // Open for as long as this lives, in every state; -1 if it never was.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  State state_ = State::kNone;
};

}  // namespace hydrodip
