#include "calibrate/store.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "contains.h"
#include "full_disk.h"
#include "no_locks.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class StoreTest : public testing::Test {
 protected:
  static SimulationKey key(double z) { return {"abc-search", {z, 600, 0.1}}; }
  static SimulationResult result(double x) {
    Landings landings;
    landings.reach = {1, 0};
    landings.corner.resize(3);
    landings.corner[0] = Landing{Vec3(x, 1.0 / 3, 0), Eigen::Matrix<double, 3, 2>::Ones()};
    landings.corner[2] = Landing{Vec3(-0.1, 1e-17, 5), -0.1 * Eigen::Matrix<double, 3, 2>::Ones()};
    return landings;
  }
  std::string text() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& content) const {
    std::ofstream(file_, std::ios::binary) << content;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "simulations.jsonl";
};

TEST_F(StoreTest, ResultsComeBackToTheLastBit) {
  {
    SimulationStore store(file_, {});
    store.add(key(0.1 + 0.2), result(0.7));
    store.add(key(0.6), std::nullopt);
  }
  const SimulationStore store(file_, {});
  EXPECT_EQ(store.size(), 2u);
  EXPECT_EQ(store.find(key(0.3)), nullptr);  // 0.1 + 0.2 is not 0.3
  const SimulationResult* found = store.find(key(0.1 + 0.2));
  ASSERT_NE(found, nullptr);
  ASSERT_TRUE(found->has_value());
  EXPECT_EQ((*found)->find({-1, 0})->position.y(), 1.0 / 3);
  EXPECT_EQ((*found)->find({0, 0}), nullptr);
  EXPECT_EQ((*found)->find({1, 0})->position.y(), 1e-17);
  EXPECT_EQ((*found)->find({2, 0}), nullptr);
  ASSERT_NE(store.find(key(0.6)), nullptr);
  EXPECT_FALSE(store.find(key(0.6))->has_value());
}

TEST_F(StoreTest, CutAtAnyByteItKeepsWholeLinesAndGoesOn) {
  {
    SimulationStore store(file_, {});
    store.add(key(0.1), result(1));
    store.add(key(0.2), result(2));
  }
  const std::string whole = text();
  const std::size_t first = whole.find('\n') + 1;
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    write(whole.substr(0, cut));
    {
      SimulationStore store(file_, {});
      EXPECT_EQ(store.size(), cut == whole.size() ? 2u : cut >= first ? 1u : 0u) << cut;
      if (!store.find(key(0.1))) store.add(key(0.1), result(1));
      if (!store.find(key(0.2))) store.add(key(0.2), result(2));
    }
    EXPECT_EQ(text(), whole);
  }
}

TEST_F(StoreTest, StoresMergeByFileAndByConcatenation) {
  const std::filesystem::path other = folder_ / "other.jsonl";
  SimulationStore(file_, {}).add(key(0.1), result(1));
  SimulationStore(other, {}).add(key(0.2), result(2));
  EXPECT_EQ(SimulationStore(file_, {other}).size(), 2u);
  const std::string both = text();
  std::ifstream in(other);
  write(both + std::string(std::istreambuf_iterator<char>(in), {}));
  EXPECT_EQ(SimulationStore(file_, {}).size(), 2u);
}

TEST_F(StoreTest, AFileThatItMadeForNothingGoesAgain) {
  { const SimulationStore store(file_, {}); }
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_THROW(SimulationStore(file_, {folder_ / "missing"}), InputError);
  EXPECT_FALSE(std::filesystem::exists(file_));
  {
    const FullDisk disk(100);  // of a line, the beginning
    SimulationStore store(file_, {});
    EXPECT_THROW(store.add(key(0.1), result(1)), InputError);
  }
  EXPECT_FALSE(std::filesystem::exists(file_));
  write("");
  { const SimulationStore store(file_, {}); }
  EXPECT_TRUE(std::filesystem::exists(file_));  // somebody else's
}

TEST_F(StoreTest, OnlyOneMayWrite) {
  const SimulationStore store(file_, {});
  EXPECT_THROW(SimulationStore(file_, {}), InputError);
}

TEST_F(StoreTest, IsKeptWhereTheFileSystemHasNoLocks) {
  const NoLocks here;
  SimulationStore store(file_, {});
  store.add(key(0.1), result(1));
  ASSERT_EQ(store.oddities({"abc"}).size(), 1u);
  EXPECT_TRUE(contains(store.oddities({"abc"})[0], "no locks"));
  EXPECT_EQ(SimulationStore(file_, {}).size(), 1u);
}

TEST_F(StoreTest, RefusesOtherFiles) {
  for (const char* content : {"hello\n", "{}\n", "{\"subject\":1}\n", "[]\n\n"}) {
    write(content);
    EXPECT_THROW(SimulationStore(file_, {}), InputError) << content;
  }
  EXPECT_THROW(SimulationStore(folder_ / "no/folder", {}), InputError);
  write("");
  EXPECT_THROW(SimulationStore(file_, {folder_ / "missing"}), InputError);
}

TEST_F(StoreTest, DamagedLinesArePassedOverAndSaid) {
  {
    SimulationStore store(file_, {});
    for (const double z : {0.1, 0.2, 0.3}) store.add(key(z), result(z));
  }
  std::string damaged = text();
  damaged.replace(damaged.find('\n') + 5, 3, "\xff\x00}");
  write(damaged);
  SimulationStore store(file_, {});
  EXPECT_EQ(store.size(), 2u);
  const auto said = store.oddities({"abc"});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("line 2"), std::string::npos);
  store.add(key(0.2), result(0.2));
  EXPECT_EQ(store.size(), 3u);
}

TEST_F(StoreTest, OlderProgramsResultsAreSaidAndNotUsed) {
  const std::filesystem::path other = folder_ / "older.jsonl";
  std::ofstream(other) << R"({"subject":"abc-search","z_stretch":0.2,"ink_stiffness_ratio":600,)"
                       << R"("poisson":0.1,"film_mm":[[1,2],null]})"
                       << "\n";
  const SimulationStore store(file_, {other});
  EXPECT_EQ(store.size(), 0u);
}

TEST_F(StoreTest, PlacesBeyondTheReachAreDamage) {
  SimulationStore(file_, {}).add(key(0.1), result(1));
  const std::string good = text();
  for (const char* corners : {"[[2,0,1,2,3,1,0,0,1,0,0]]", "[[0,0,1,2,3,1,0,0,1,0]]", "[1]",
                              "[[0.5,0,1,2,3,1,0,0,1,0,0]]", "7"}) {
    std::string bad = good;
    const std::size_t at = bad.find("\"corners\":") + 10;
    bad = bad.substr(0, at) + corners + "}\n";
    write(good + bad);
    EXPECT_EQ(SimulationStore(file_, {}).oddities({"abc"}).size(), 1u) << corners;
  }
}

TEST_F(StoreTest, ResultsOfOtherSubjectsAreSaid) {
  const std::filesystem::path other = folder_ / "other.jsonl";
  SimulationStore(other, {}).add(key(0.2), result(2));
  const SimulationStore store(file_, {other});
  EXPECT_TRUE(store.oddities({"abc"}).empty());
  const auto said = store.oddities({"def"});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("1 of its 1 simulations are not used"), std::string::npos);
}

}  // namespace
}  // namespace hydrodip
