#include "base/folder_lock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <optional>
#include <thread>

#include "temporary_folder.h"

namespace hydrodip {
namespace {

using State = FolderLock::State;

TEST(FolderLock, OneHasItAtATime) {
  const TemporaryFolder folder;
  std::optional<FolderLock> first(folder.path());
  ASSERT_EQ(first->state(), State::kHeld);
  EXPECT_EQ(FolderLock(folder.path()).state(), State::kTaken);
  FolderLock moved = std::move(*first);
  first.reset();
  EXPECT_EQ(FolderLock(folder.path()).state(), State::kTaken);
  moved = FolderLock();
  EXPECT_EQ(FolderLock(folder.path()).state(), State::kHeld);
}

TEST(FolderLock, WaitsForWhoeverHasIt) {
  const TemporaryFolder folder;
  std::optional<FolderLock> first(folder.path());
  std::atomic<bool> let_go = false;
  std::latch begun(1);
  std::thread other([&] {
    begun.count_down();
    EXPECT_EQ(FolderLock::waited_for(folder.path()).state(), State::kHeld);
    EXPECT_TRUE(let_go);
  });
  begun.wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  let_go = true;
  first.reset();
  other.join();
}

TEST(FolderLock, NothingIsLockedWhereThereIsNoFolder) {
  const TemporaryFolder folder;
  EXPECT_EQ(FolderLock(folder / "none").state(), State::kGone);
  const FolderLock removed(folder.path());
  std::filesystem::remove_all(folder.path());
  EXPECT_EQ(removed.state(), State::kHeld);  // of what was there
  std::filesystem::create_directory(folder.path());
  EXPECT_EQ(FolderLock(folder.path()).state(), State::kHeld);
}

}  // namespace
}  // namespace hydrodip
