#include "base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/file_lock.h"
#include "base/run_scope.h"
#include "contains.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

// FIPS 180-2, appendix B.
TEST(Sha256, PublishedVectors) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(File, WhatIsWrittenIsRead) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += char(i * 7);
  const TemporaryFolder folder;
  const auto path = folder / "round_trip";
  write_file(path, text);
  const auto bytes = read_file(path);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text);
  write_file(path, "");
  EXPECT_TRUE(read_file(path).empty());
}

std::string text_in(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

std::size_t entries_of(const std::filesystem::path& folder) {
  return std::size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(WholeFile, TakesTheOldOnesPlaceAndPermissions) {
  const TemporaryFolder folder;
  write_whole(folder / "file", "old");
  std::filesystem::create_symlink("file", folder / "link");
  const auto mode = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  std::filesystem::permissions(folder / "file", mode);
  write_whole(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(text_in(folder / "file"), "new");
  EXPECT_EQ(std::filesystem::status(folder / "file").permissions(), mode);
  EXPECT_EQ(entries_of(folder.path()), 2U);
  const std::string long_name(255, 'n');
  write_whole(folder / long_name, "long");
  EXPECT_EQ(text_in(folder / long_name), "long");
}

TEST(WholeFile, LeavesNothingWhereItEndsEarly) {
  const TemporaryFolder folder;
  write_whole(folder / "file", "old");
  const std::string text(std::size_t(3) << 20U, 'x');
  {
    const RunContext context;
    const RunScope scope(context);
    context.cancel_at_check(2);
    EXPECT_THROW(write_whole(folder / "file", text), Cancelled);
  }
  EXPECT_EQ(text_in(folder / "file"), "old");
  EXPECT_EQ(entries_of(folder.path()), 1U);
}

TEST(WholeFile, ClearsUpWhatKilledProcessesLeftAndNothingElse) {
  const TemporaryFolder folder;
  write_file(folder / ".hydrodip-1-0.part", "left");
  write_file(folder / ".hydrodip-1-1.part", "being written");
  const auto written = folder / ".hydrodip-1-1.part";
  const FileLock lock(::open(written.c_str(), O_WRONLY | O_CLOEXEC), written);
  ASSERT_EQ(lock.state(), FileLock::State::kHeld);
  const std::array<const char*, 4> of_others = {".hydrodip-1-x.part", ".hydrodip-mine.part",
                                                "hydrodip-1-0.part", ".hydrodip-1-0.part.old"};
  for (const char* name : of_others) write_file(folder / name, "mine");
  std::filesystem::create_symlink(of_others[0], folder / ".hydrodip-2-0.part");
  std::filesystem::create_directory(folder / ".hydrodip-3-0.part");
  write_whole(folder / "file", "new");
  EXPECT_FALSE(std::filesystem::exists(folder / ".hydrodip-1-0.part"));
  EXPECT_EQ(text_in(written), "being written");
  for (const char* name : of_others) EXPECT_EQ(text_in(folder / name), "mine");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / ".hydrodip-2-0.part"));
  EXPECT_TRUE(std::filesystem::is_directory(folder / ".hydrodip-3-0.part"));
  EXPECT_EQ(text_in(folder / "file"), "new");
  EXPECT_EQ(entries_of(folder.path()), of_others.size() + 4);
}

// Each clears up before it writes: none may take another's part for left behind.
TEST(WholeFile, ManyThatAreWrittenAtOnceAllCome) {
  const TemporaryFolder folder;
  const std::string text(std::size_t(1) << 16U, 'x');
  std::vector<std::thread> writers;
  writers.reserve(4);
  for (int writer = 0; writer < 4; ++writer)
    writers.emplace_back([&, writer] {
      for (int n = 0; n < 50; ++n) write_whole(folder / std::to_string(100 * writer + n), text);
    });
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(entries_of(folder.path()), 200U);
}

TEST(WholeFile, IsRefusedWhereItMayNotBe) {
  const TemporaryFolder folder;
  write_whole(folder / "file", "old");
  EXPECT_TRUE(contains(
      refusal([&] { write_whole(folder / "file", "new", 3, ExistingFile::kKept); }), "file"));
  EXPECT_EQ(text_in(folder / "file"), "old");
  write_whole(folder / "other", "new", 3, ExistingFile::kKept);
  EXPECT_EQ(text_in(folder / "other"), "new");
  EXPECT_NE(refusal([&] { write_whole(folder.path(), "text"); }), "");
  EXPECT_NE(refusal([&] { write_whole(folder / "none/file", "text"); }), "");
  EXPECT_EQ(entries_of(folder.path()), 2U);
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_NE(refusal([&] { write_whole("/dev/full", std::string(100000, 'x')); }), "");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  }
}

TEST(File, PipesAreReadToTheirEnd) {
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string text(300000, 'x');  // more than a pipe holds
  std::thread writer([&] { write_file(pipe, text); });
  const std::vector<std::uint8_t> bytes = read_file(pipe);
  writer.join();
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text);
}

TEST(File, APipeThatNobodyWritesToCanBeGivenUp) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const RunContext context;
  const RunScope scope(context);
  context.cancel_at_check(3);
  EXPECT_THROW(read_file(folder / "pipe"), Cancelled);
}

TEST(File, WhatIsNoFileIsRefusedForWhatItIs) {
  EXPECT_TRUE(contains(refusal([] { read_file("/dev/zero"); }), "it is a device"));
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(refusal([&] { read_file(folder.path()); }), "it is a folder"));
}

TEST(File, ErrorsNameThePath) {
  const auto check = [](const auto& action, const std::string& name) {
    try {
      action();
      ADD_FAILURE() << "not refused: " << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
    }
  };
  const TemporaryFolder folder;
  const auto missing = folder / "missing";
  check([&] { read_file(missing); }, missing.string());
  check([&] { read_file(folder.path()); }, folder.path().string());
  check([&] { write_file(missing / "file", "text"); }, (missing / "file").string());
  if (std::filesystem::exists("/dev/full")) {
    check([&] { write_file("/dev/full", std::string(100000, 'x')); }, "/dev/full");
  }
}

}  // namespace
}  // namespace hydrodip
