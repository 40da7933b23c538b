#include "base/file_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <optional>

#include "temporary_folder.h"

namespace hydrodip {
namespace {

using State = FileLock::State;

int opened(const std::filesystem::path& file, int flags = O_RDWR | O_CREAT) {
  return ::open(file.c_str(), flags | O_CLOEXEC, 0666);
}

TEST(FileLock, IsOfTheFileThatHasTheName) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "file";
  std::optional<FileLock> first(std::in_place, opened(file), file);
  EXPECT_EQ(first->state(), State::kHeld);
  EXPECT_EQ(FileLock(opened(file), file).state(), State::kTaken);
  // Who opened it before it was removed has a file that no one else will find.
  const int before = opened(file);
  std::filesystem::remove(file);
  first.reset();
  const FileLock second(opened(file), file);
  EXPECT_EQ(FileLock(before, file).state(), State::kGone);
  EXPECT_EQ(second.state(), State::kHeld);
}

TEST(FileLock, WhatCannotBeLockedIsNotTaken) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "file";
  const FileLock made(opened(file), file);
  const FileLock lock(opened(file, O_PATH), file);  // no lock is had through such a descriptor
  EXPECT_EQ(lock.state(), State::kNone);
  EXPECT_GE(lock.descriptor(), 0);
  EXPECT_EQ(FileLock(-1, file).state(), State::kGone);
}

}  // namespace
}  // namespace hydrodip
