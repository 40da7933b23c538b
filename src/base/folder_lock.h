// A folder that one holder has at a time, in this process or another.
#pragma once

#include <filesystem>
#include <utility>

namespace hydrodip {

// The lock goes with the process, however that ends.
class FolderLock {
 public:
  enum class State {
    kHeld,
    kTaken,  // by another holder
    kGone,   // there is no such folder, or it was removed meanwhile
    kNone,   // nothing is locked here: the file system has no locks
  };

  FolderLock() = default;
  explicit FolderLock(const std::filesystem::path& folder);
  // Waits for whoever has it, which has to take no more than milliseconds.
  static FolderLock waited_for(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), state_(other.state_) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(state_, other.state_);
    return *this;
  }

  State state() const { return state_; }

 private:
  FolderLock(const std::filesystem::path& folder, bool waits);

  int descriptor_ = -1;
  State state_ = State::kNone;
};

}  // namespace hydrodip
