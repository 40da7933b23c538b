#include "base/output_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "full_disk.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string read(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

class OutputFolderTest : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const fs::path& root_ = folder_.path();
};

TEST_F(OutputFolderTest, FilesAppearAtCommitAndNothingElseRemains) {
  const fs::path out = root_ / "a" / "b";
  {
    OutputFolder folder(out);
    write(folder.path("one.txt"), "1");
    write(folder.path("two.txt"), "2");
    EXPECT_FALSE(fs::exists(out / "one.txt"));
    folder.commit();
  }
  EXPECT_EQ(read(out / "one.txt"), "1");
  EXPECT_EQ(read(out / "two.txt"), "2");
  EXPECT_EQ(entries(out), 2);
}

TEST_F(OutputFolderTest, StagedFilesAreHidden) {
  OutputFolder folder(root_);
  write(folder.path("one.txt"), "1");
  for (const auto& entry : fs::directory_iterator(root_)) {
    EXPECT_EQ(entry.path().filename().string().front(), '.');
  }
}

TEST_F(OutputFolderTest, WhatCannotBeWrittenIsToldByItsFinalName) {
  OutputFolder folder(root_ / "out");
  const fs::path staged = folder.path("dip-1/print.png");
  const std::vector<std::uint8_t> bytes(1000);
  try {
    const FullDisk disk(100);
    write_file(staged, bytes.data(), bytes.size());
    FAIL() << "a full disk takes it all";
  } catch (const InputError& error) {
    const std::string said = error.what(), name = (root_ / "out/dip-1/print.png").string();
    EXPECT_TRUE(said.starts_with(name + ": cannot be written")) << said;
  }
}

TEST_F(OutputFolderTest, WithoutCommitNothingIsLeftBehind) {
  {
    OutputFolder folder(root_ / "a" / "b" / "c");
    write(folder.path("one.txt"), "1");
    EXPECT_TRUE(fs::is_directory(root_ / "a" / "b" / "c"));
  }
  EXPECT_EQ(entries(root_), 0);
}

TEST_F(OutputFolderTest, WithoutCommitExistingFoldersAndFilesStay) {
  fs::create_directory(root_ / "a");
  write(root_ / "a" / "keep.txt", "mine");
  {
    OutputFolder folder(root_ / "a");
    write(folder.path("keep.txt"), "new");
    EXPECT_EQ(read(root_ / "a" / "keep.txt"), "mine");
  }
  EXPECT_EQ(read(root_ / "a" / "keep.txt"), "mine");
  EXPECT_EQ(entries(root_ / "a"), 1);
}

// A print of two dips where one of three lay: its third sheet would be dipped with the others.
TEST_F(OutputFolderTest, WhatAnEarlierResultHadAndThisOneHasNotGoes) {
  const fs::path out = root_ / "out";
  for (const char* folder : {"dip-3", "dip-4", "dip-5", "dip-6"})
    fs::create_directories(out / folder);
  write(out / "dip-3/print.pdf", "by hydrodip");
  write(out / "dip-3/print.tif", "says nothing");
  write(out / "dip-4/print.pdf", "by hydrodip");
  write(out / "dip-4/notes.txt", "a person's own, about hydrodip");
  write(out / "dip-5/print.pdf", "by somebody else");
  write(out / "dip-6/print.pdf", "by hydrodip, and the job reads it");
  OutputFolder folder(out);
  folder.announce({"dip-1/print.pdf"}, {out / "dip-6/print.pdf"});
  std::vector<std::string> names = {"dip-1/print.pdf"};
  for (const char* dip : {"dip-3/", "dip-4/", "dip-5/", "dip-6/"})
    for (const char* name : {"print.pdf", "print.tif"}) names.push_back(std::string(dip) + name);
  folder.supersede(names);
  write(folder.path("dip-1/print.pdf"), "by hydrodip, new");
  EXPECT_TRUE(fs::exists(out / "dip-3/print.pdf"));
  folder.commit();
  EXPECT_EQ(read(out / "dip-1/print.pdf"), "by hydrodip, new");
  EXPECT_FALSE(fs::exists(out / "dip-3"));
  EXPECT_FALSE(fs::exists(out / "dip-4/print.pdf"));
  EXPECT_TRUE(fs::exists(out / "dip-4/notes.txt"));
  EXPECT_TRUE(fs::exists(out / "dip-5/print.pdf"));
  EXPECT_TRUE(fs::exists(out / "dip-6/print.pdf"));
}

// A draft has no pictures: one that lies beside its report is a person's, and one that its report
// names is its own.
TEST_F(OutputFolderTest, TheEarlierReportTellsWhoWroteWhat) {
  const auto report = [&](const std::string& outputs) {
    write(root_ / "report.json", "{\n  \"command\": \"print\", \"outputs\": [" + outputs +
                                     "{\"name\": \"report.json\"}]}");
  };
  report("");
  write(root_ / "preview.png", "mine");
  const auto why = [&] {
    OutputFolder folder(root_);
    try {
      folder.announce({"preview.png", "report.json"}, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(why().find("preview.png: this file was not written by hydrodip"), std::string::npos);
  report("{\"name\": \"preview.png\"},");
  EXPECT_EQ(why(), "");
}

TEST_F(OutputFolderTest, PicturesOfAnEarlierResultGoAndOnesOfPeopleStay) {
  write(root_ / "report.json",
        "{\"command\": \"print\", \"by\": \"hydrodip\", \"outputs\": [{\"name\": \"maps.png\"}]}");
  write(root_ / "maps.png", "of an earlier job");
  write(root_ / "gamut.png", "mine");
  OutputFolder folder(root_);
  folder.announce({"report.json"}, {});
  folder.supersede({"maps.png", "gamut.png"});
  write(folder.path("report.json"), "{\"command\": \"print\", \"outputs\": []}");
  folder.commit();
  EXPECT_FALSE(fs::exists(root_ / "maps.png"));
  EXPECT_EQ(read(root_ / "gamut.png"), "mine");
  EXPECT_EQ(folder.told_replaced(), "replaced the earlier result there; gone with it: maps.png\n");
}

// Two jobs into one folder, neither of which may replace anything: the second finds the first's.
TEST_F(OutputFolderTest, WhatCameMeanwhileIsKeptToo) {
  OutputFolder folder(root_, EarlierResult::kKept);
  folder.announce({"one.txt"}, {});
  write(folder.path("one.txt"), "new");
  write(root_ / "one.txt", "faster");
  EXPECT_THROW(folder.commit(), InputError);
  EXPECT_EQ(read(root_ / "one.txt"), "faster");
}

TEST_F(OutputFolderTest, CommitReplacesEarlierFilesAndLeavesOthersAlone) {
  write(root_ / "one.txt", "old");
  write(root_ / "other.txt", "other");
  OutputFolder folder(root_);
  write(folder.path("one.txt"), "new");
  folder.commit();
  EXPECT_EQ(read(root_ / "one.txt"), "new");
  EXPECT_EQ(read(root_ / "other.txt"), "other");
  EXPECT_EQ(entries(root_), 2);
}

TEST_F(OutputFolderTest, AskingTwiceForANameIsOneFile) {
  OutputFolder folder(root_);
  write(folder.path("one.txt"), "first");
  write(folder.path("one.txt"), "second");
  folder.commit();
  EXPECT_EQ(read(root_ / "one.txt"), "second");
}

TEST_F(OutputFolderTest, AMissingFileStopsTheCommitBeforeAnythingMoves) {
  write(root_ / "one.txt", "old");
  {
    OutputFolder folder(root_);
    write(folder.path("one.txt"), "new");
    folder.path("two.txt");
    EXPECT_THROW(folder.commit(), InputError);
    EXPECT_EQ(read(root_ / "one.txt"), "old");
  }
  EXPECT_EQ(read(root_ / "one.txt"), "old");
  EXPECT_EQ(entries(root_), 1);
}

TEST_F(OutputFolderTest, AFolderInTheWayIsRefusedByName) {
  write(root_ / "one.txt", "old");
  fs::create_directory(root_ / "two.txt");
  OutputFolder folder(root_);
  write(folder.path("one.txt"), "new");
  write(folder.path("two.txt"), "new");
  try {
    folder.commit();
    FAIL() << "commit over a folder";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("two.txt"), std::string::npos);
  }
  EXPECT_EQ(read(root_ / "one.txt"), "old");
  EXPECT_TRUE(fs::is_directory(root_ / "two.txt"));
}

TEST_F(OutputFolderTest, PipesAndDevicesAreRefusedBeforeAndAfterTheWork) {
  ASSERT_EQ(mkfifo((root_ / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/full", root_ / "link");
  fs::create_directory(root_ / "folder");
  for (const auto& [name, what] :
       {std::pair{"pipe", "a pipe"}, {"link", "a device"}, {"folder", "a folder"}}) {
    OutputFolder folder(root_);
    write(folder.path(name), "new");
    for (const bool after : {false, true}) try {
        after ? folder.commit() : folder.announce({name}, {});
        ADD_FAILURE() << name;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      }
  }
  EXPECT_TRUE(fs::is_fifo(root_ / "pipe"));
  EXPECT_TRUE(fs::is_symlink(root_ / "link"));
  EXPECT_EQ(entries(root_), 3);
}

TEST_F(OutputFolderTest, AFailureHalfWayRestoresWhatWasThere) {
  write(root_ / "one.txt", "old");
  write(root_ / "three.txt", "old");
  {
    OutputFolder folder(root_);
    for (const char* name : {"one.txt", "two.txt", "three.txt"}) write(folder.path(name), "new");
    // Blocks the place where the earlier three.txt would be kept, so that the third move fails.
    const fs::path staging = folder.path("one.txt").parent_path();
    fs::create_directories(staging / "..earlier" / "three.txt" / "blocker");
    EXPECT_THROW(folder.commit(), InputError);
    EXPECT_EQ(read(root_ / "one.txt"), "old");
    EXPECT_EQ(read(root_ / "three.txt"), "old");
    EXPECT_FALSE(fs::exists(root_ / "two.txt"));
  }
  EXPECT_EQ(entries(root_), 2);
}

TEST_F(OutputFolderTest, ASymbolicLinkIsReplacedNotFollowed) {
  write(root_ / "target.txt", "precious");
  fs::create_symlink(root_ / "target.txt", root_ / "one.txt");
  OutputFolder folder(root_);
  write(folder.path("one.txt"), "new");
  folder.commit();
  EXPECT_EQ(read(root_ / "target.txt"), "precious");
  EXPECT_EQ(read(root_ / "one.txt"), "new");
  EXPECT_FALSE(fs::is_symlink(root_ / "one.txt"));
}

TEST_F(OutputFolderTest, AFolderBelowAFileIsRefusedInOneSentence) {
  write(root_ / "file", "x");
  for (const fs::path& bad : {root_ / "file", root_ / "file" / "sub", root_ / "file" / "a" / "b"}) {
    try {
      OutputFolder folder(bad);
      FAIL() << bad;
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(bad.string()), std::string::npos) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
  }
  EXPECT_EQ(read(root_ / "file"), "x");
  EXPECT_EQ(entries(root_), 1);
}

TEST_F(OutputFolderTest, FoldersMadeOnTheWayToARefusalAreRemoved) {
  const std::string long_name(300, 'x');
  EXPECT_THROW(OutputFolder(root_ / "a" / "b" / long_name), InputError);
  EXPECT_EQ(entries(root_), 0);
}

TEST_F(OutputFolderTest, TrailingSlashAndEmptyPathAreFolders) {
  {
    OutputFolder folder(root_ / "a" / "");
    write(folder.path("one.txt"), "1");
    folder.commit();
  }
  EXPECT_EQ(read(root_ / "a" / "one.txt"), "1");
  const fs::path before = fs::current_path();
  fs::current_path(root_);
  {
    OutputFolder folder("");
    write(folder.path("here.txt"), "1");
    folder.commit();
  }
  fs::current_path(before);
  EXPECT_EQ(read(root_ / "here.txt"), "1");
}

TEST_F(OutputFolderTest, OnlyPlainNamesAreAccepted) {
  OutputFolder folder(root_);
  for (const char* bad : {"", ".", "..", "a/", "a/../b", "./a", "/etc/passwd", "../x"}) {
    EXPECT_THROW(folder.path(bad), std::logic_error) << bad;
  }
}

TEST_F(OutputFolderTest, FilesInFoldersInsideAppearTogetherWithTheOthers) {
  {
    OutputFolder folder(root_);
    write(folder.path("part-1/a.txt"), "1");
    write(folder.path("a.txt"), "2");
    EXPECT_FALSE(fs::exists(root_ / "part-1"));
    folder.commit();
  }
  EXPECT_EQ(read(root_ / "part-1" / "a.txt"), "1");
  EXPECT_EQ(read(root_ / "a.txt"), "2");
  {
    OutputFolder folder(root_);
    write(folder.path("part-1/a.txt"), "3");
    write(folder.path("part-2/a.txt"), "4");
    // never committed
  }
  EXPECT_EQ(read(root_ / "part-1" / "a.txt"), "1");
  EXPECT_FALSE(fs::exists(root_ / "part-2"));
  {
    OutputFolder folder(root_);
    write(folder.path("part-1/a.txt"), "5");
    folder.commit();
  }
  EXPECT_EQ(read(root_ / "part-1" / "a.txt"), "5");
}

TEST_F(OutputFolderTest, InputsAreNotOverwritten) {
  write(root_ / "texture.png", "mine");
  OutputFolder folder(root_);
  folder.announce({"other.png"}, {root_ / "texture.png"});
  EXPECT_THROW(folder.announce({"texture.png"}, {root_ / "." / "texture.png"}), InputError);
  fs::create_symlink(root_ / "texture.png", root_ / "link.png");
  EXPECT_THROW(folder.announce({"link.png"}, {root_ / "texture.png"}), InputError);
}

TEST_F(OutputFolderTest, FilesOfOthersAreNotReplaced) {
  write(root_ / "report.json", "{}");
  OutputFolder folder(root_);
  EXPECT_THROW(folder.announce({"report.json"}, {}), InputError);
  write(root_ / "report.json", std::string(100000, ' ') + "by hydrodip");
  folder.announce({"report.json"}, {});
  // A file without a mark belongs to one with it.
  write(root_ / "picture.png", "pixels");
  folder.announce({"report.json", "picture.png"}, {});
  EXPECT_THROW(folder.announce({"picture.png"}, {}), InputError);
}

TEST_F(OutputFolderTest, SaysWhetherEarlierFilesWereReplaced) {
  for (const bool again : {false, true}) {
    OutputFolder folder(root_);
    write(folder.path("a.txt"), "a");
    folder.commit();
    EXPECT_EQ(folder.replaced_earlier(), again);
  }
}

TEST_F(OutputFolderTest, ClearsWhatKilledProcessesLeft) {
  fs::create_directories(root_ / ".hydrodip-dead00" / "..earlier");
  write(root_ / ".hydrodip-dead00" / "half.png", "half");
  fs::create_directories(root_ / ".hydrodip-settings");  // not by that name
  const OutputFolder living(root_);
  EXPECT_FALSE(fs::exists(root_ / ".hydrodip-dead00"));
  EXPECT_TRUE(fs::exists(root_ / ".hydrodip-settings"));
  const std::ptrdiff_t with_one = entries(root_);
  const OutputFolder second(root_);
  EXPECT_EQ(entries(root_), with_one + 1);  // the living one's is left alone
}

TEST_F(OutputFolderTest, KeepsAnEarlierResultWhereThatIsAsked) {
  for (const char* text : {"hydrodip 1", "hydrodip 2"}) {
    OutputFolder folder(root_);
    folder.announce({"one.txt"}, {});
    write(folder.path("one.txt"), text);
    folder.commit();
  }
  EXPECT_EQ(read(root_ / "one.txt"), "hydrodip 2");
  OutputFolder keeping(root_, EarlierResult::kKept);
  EXPECT_THROW(keeping.announce({"two.txt", "one.txt"}, {}), InputError);
  EXPECT_NO_THROW(keeping.announce({"two.txt"}, {}));
}

}  // namespace
}  // namespace hydrodip
