#include "base/made_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.h"

namespace hydrodip {
namespace {

TEST(MadeFolder, GoesAgainWithAllThatWasMadeOfItsPathIfItStaysEmpty) {
  const TemporaryFolder there;
  {
    const MadeFolder made(there / "a" / "b" / "c");
    EXPECT_FALSE(made.error());
    EXPECT_TRUE(std::filesystem::is_directory(there / "a" / "b" / "c"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(there.path()));
}

TEST(MadeFolder, StaysWithWhatWasWrittenIntoIt) {
  const TemporaryFolder there;
  {
    const MadeFolder made(there / "a" / "b");
    std::ofstream(there / "a" / "file") << "kept";
  }
  EXPECT_TRUE(std::filesystem::exists(there / "a" / "file"));
  EXPECT_FALSE(std::filesystem::exists(there / "a" / "b"));
}

TEST(MadeFolder, LeavesWhatWasThereBefore) {
  const TemporaryFolder there;
  std::filesystem::create_directory(there / "a");
  { const MadeFolder made(there / "a"); }
  EXPECT_TRUE(std::filesystem::is_directory(there / "a"));
}

TEST(MadeFolder, TellsWhyItCannotBeMade) {
  const TemporaryFolder there;
  std::ofstream(there / "file") << "in the way";
  EXPECT_TRUE(MadeFolder(there / "file" / "a").error());
  EXPECT_TRUE(std::filesystem::is_regular_file(there / "file"));
}

}  // namespace
}  // namespace hydrodip
