#include "settings/job_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "contains.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

class JobFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("job_file_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  JobConfig read(const std::string& text) {
    std::ofstream(folder_ / "job.toml", std::ios::binary) << text;
    JobConfig config;
    apply_settings(config, read_settings(folder_ / "job.toml"));
    return config;
  }

  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

TEST_F(JobFile, NamesItsModelFromWhereItLies) {
  EXPECT_EQ(read("[object]\nfile = \"models/a.obj\"\n").model, folder_ / "models/a.obj");
}

TEST_F(JobFile, HasDips) {
  const JobConfig config = read(
      "[[dip]]\ndown = \"+x\"\nrotate_deg = [1, 2, 3]\ndepth_mm = 20\nlocked = true\n"
      "[[dip]]\nrotate_deg = \"auto\"\n[[dip]]\n"
      "[[dip]]\npath = [[0, 0, 0, 0, 0, 0], [20, 5, 0, 0, 10, 0]]\n");
  ASSERT_EQ(config.dips.size(), 4U);
  EXPECT_EQ(config.dips[0].down, ModelSide::kPlusX);
  EXPECT_EQ(*config.dips[0].rotate_deg, Vec3(1, 2, 3));
  EXPECT_EQ(config.dips[0].depth_mm, 20);
  EXPECT_TRUE(config.dips[0].locked);
  EXPECT_FALSE(config.dips[1].rotate_deg || config.dips[1].depth_mm || config.dips[1].locked);
  EXPECT_FALSE(config.dips[2].down || config.dips[2].rotate_deg);
  ASSERT_EQ(config.dips[3].path.size(), 2U);
  EXPECT_EQ(config.dips[3].path[1].turn_y_deg, 10);
}

TEST_F(JobFile, WhatHoldsForAllDipsStandsInDips) {
  const JobConfig config = read("[dips]\nstep_mm = 0.3\n[[dip]]\n[[dip]]\n");
  EXPECT_EQ(config.design.dip.step_mm, 0.3);
  EXPECT_EQ(config.dips.size(), 2U);
}

TEST_F(JobFile, ATableThatSaysNothingIsNotPassedOver) {
  EXPECT_EQ(read("[[artwork]]\n").object.artwork.size(), 1U);
  const JobConfig two = read("[[artwork]]\n[[artwork]]\ntext = \"a\"\n");
  ASSERT_EQ(two.object.artwork.size(), 2U);
  EXPECT_EQ(two.object.artwork[1].text, "a");
  EXPECT_EQ(read("[[part]]\n[[part]]\n").parts.size(), 2U);
}

TEST_F(JobFile, APathAndADepthOfOneDipAreRefused) {
  std::ofstream(folder_ / "way.csv") << "lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_"
                                        "z_deg\n0,0,0,0,0,0\n9,0,0,0,0,0\n";
  const auto file = (folder_ / "job.toml").string();
  for (const char* text : {"[[dip]]\npath = \"way.csv\"\ndepth_mm = 3\n",
                           "path = \"way.csv\"\n[[dip]]\n[[dip]]\ndepth_mm = 3\n"}) {
    if (text[0] != 'p') std::ofstream(file) << "object.file = \"a.obj\"\n" << text;
    if (text[0] == 'p') std::ofstream(file) << text << "[object]\nfile = \"a.obj\"\n";
    try {
      configured(file, {});
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_TRUE(contains(error.what(), "leave out depth_mm")) << error.what();
    }
  }
}

// Each dip has its own: one for all would be passed over.
TEST_F(JobFile, OneDepthForSeveralDipsIsRefused) {
  const auto told = [&](const std::string& text, const SettingSources& more = {}) {
    const auto file = (folder_ / "job.toml").string();
    std::ofstream(file) << "object.file = \"a.obj\"\n" << text;
    try {
      configured(file, more);
      return std::string("accepted");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  SettingSources by_hand;
  by_hand.sets = {parse_set("dip.depth_mm=5")};
  for (const char* depth : {"3", "0"}) {
    const std::string common = fmt::format("[dips]\ndepth_mm = {}\n", depth);
    for (const char* tables : {"[[dip]]\n", "[[dip]]\n[[dip]]\ndepth_mm = 4\n"})
      EXPECT_TRUE(
          contains(told(common + tables), "job.toml:3: dips.depth_mm: each of several dips"))
          << told(common + tables);
  }
  EXPECT_TRUE(
      contains(told("[plan]\ndips = 2\n[dip]\ndepth_mm = 3\n"), "job.toml:5: dip.depth_mm"));
  EXPECT_TRUE(contains(told("[plan]\ndips = 2\n[dips]\ndepth_mm = 3\n[[dip]]\ndepth_mm = 4\n"),
                       "job.toml:5: dips.depth_mm"));
  EXPECT_TRUE(contains(told("[dips]\ndepth_mm = 3\n[[dip]]\ndepth_mm = 4\n", by_hand),
                       "--set dip.depth_mm: "));
  // It is looked for, or every dip says its own.
  EXPECT_EQ(told("[dips]\ndepth_mm = \"auto\"\n[[dip]]\n[[dip]]\n"), "accepted");
  EXPECT_EQ(told("[plan]\ndips = 1\n[dip]\ndepth_mm = 3\n"), "accepted");
  EXPECT_EQ(told("[dips]\ndepth_mm = 3\n[[dip]]\ndepth_mm = 4\n[[dip]]\n"
                 "path = [[0, 0, 0, 0, 0, 0], [9, 0, 0, 0, 0, 0]]\n"),
            "accepted");
}

// Of many tables: whose it is.
TEST_F(JobFile, APathFileThatIsNotThereIsToldWithItsPlace) {
  const std::string file = (folder_ / "gone.csv").string() + ": cannot be read";
  EXPECT_TRUE(contains(refusal("[[dip]]\n[[dip]]\npath = \"gone.csv\"\n"),
                       "job.toml:3: [[dip]] 2: path: " + file));
  EXPECT_TRUE(contains(refusal("path = \"gone.csv\"\n"), "job.toml:1: path: " + file));
  std::ofstream(folder_ / "gone.csv") << "1,2,3\n";
  EXPECT_TRUE(contains(refusal("[[dip]]\npath = \"gone.csv\"\n"), "job.toml:2: [[dip]] 1: path: "));
}

TEST_F(JobFile, ARotationToBeFoundIsOneBesideTheSideThatGoesDown) {
  const JobConfig config =
      read("[[dip]]\ndown = \"+x\"\nrotate_deg = \"auto\"\n[[dip]]\ndown = \"+x\"\n");
  EXPECT_TRUE(config.dips[0].find_rotation);
  EXPECT_FALSE(config.dips[1].find_rotation);
  EXPECT_TRUE(read(job_file(config, folder_)).dips[0].find_rotation);
}

TEST_F(JobFile, OfPartsIsNoJobOfOneObject) {
  const auto file = (folder_ / "job.toml").string();
  std::ofstream(file) << "object.file = \"a.obj\"\n[[part]]\njob = \"b.toml\"\n";
  try {
    configured(file, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "hydrodip nest --config"));
  }
}

TEST_F(JobFile, ReadsWhatItWrites) {
  JobConfig config;
  config.model = folder_ / "a \"b\" \\ c.obj";
  config.object.pose.size_mm = 80;
  config.object.base = {0.2F, 0.3F, 0.4F, 1};
  config.design.film.width_mm = 300.5;
  config.design.dip.step_mm = 0.25;
  config.design.dip.material.tear_stretch = 1.3;
  config.plan.overlap_mm = 3;
  config.stage.lowest_mm = 120;
  config.dips.resize(3);
  config.dips[0].rotate_deg = Vec3(10, -20, 30);
  config.dips[0].depth_mm = 12.3;
  config.dips[1].down = ModelSide::kMinusY;
  config.dips[1].locked = true;
  config.dips[2].path = {{}, {15, 1, 2, 3, 4, 5}};
  const JobConfig again = read(job_file(config, folder_));
  EXPECT_TRUE(std::filesystem::weakly_canonical(again.model) ==
              std::filesystem::weakly_canonical(config.model));
  for (const Parameter& p : parameters()) {
    if (p.name == "object.file") continue;
    EXPECT_TRUE(p.get(again) == p.get(config)) << p.name;
  }
  ASSERT_EQ(again.dips.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(again.dips[k].down, config.dips[k].down);
    EXPECT_EQ(again.dips[k].rotate_deg, config.dips[k].rotate_deg);
    EXPECT_EQ(again.dips[k].depth_mm, config.dips[k].depth_mm);
    EXPECT_EQ(again.dips[k].locked, config.dips[k].locked);
  }
  EXPECT_EQ(again.dips[2].path[1].turn_z_deg, 5);
}

// One table for each layer, the bottom one first, with the ways in and what letters there are.
TEST_F(JobFile, ReadsLayersAndWaysThatItWrites) {
  JobConfig config;
  config.model = folder_ / "a.obj";
  config.design.trajectory.path = {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}};
  config.object.artwork.resize(2);
  config.object.artwork[0].image = folder_ / "a.png";
  config.object.artwork[0].width_mm = 40;
  config.object.artwork[0].height_mm = 25;
  config.object.artwork[0].at_mm = Vec3(1, 2, 3);
  config.object.artwork[0].through = true;
  config.object.artwork[1].text = "one\ntwo\t\x7f \"three\"";
  config.object.artwork[1].width_mm = 30;
  config.dips.resize(1);
  config.dips[0].path = {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}};
  const JobConfig again = read(job_file(config, folder_));
  ASSERT_EQ(again.object.artwork.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    ArtworkLayer layer = again.object.artwork[n];
    if (n == 0) layer.image = std::filesystem::weakly_canonical(layer.image);
    ArtworkLayer wanted = config.object.artwork[n];
    if (n == 0) wanted.image = std::filesystem::weakly_canonical(wanted.image);
    EXPECT_EQ(layer_values(layer), layer_values(wanted));
  }
  EXPECT_EQ(again.object.artwork[0].height_mm, 25);
  EXPECT_EQ(again.object.artwork[1].height_mm, 0);
  EXPECT_EQ(path_text(again.design.trajectory.path), "[[1, 2, 3, 4, 5, 6], [7, 8, 9, 10, 11, 12]]");
  EXPECT_EQ(path_text(again.dips.at(0).path), "[[1, 2, 3, 4, 5, 6], [7, 8, 9, 10, 11, 12]]");
}

TEST_F(JobFile, ALaterDepthToBeFoundTakesAnEarlierOneAway) {
  JobConfig config;
  config.dips.resize(1);
  config.dips[0].depth_mm = 5;
  apply_settings(config, {{"dip[1].depth_mm", std::string("auto"), false, "'auto'", "--set"}});
  EXPECT_FALSE(config.dips[0].depth_mm);
}

TEST_F(JobFile, ATextIsOneLine) {
  EXPECT_EQ(refusal("[print]\njob_name = \"one\"\n"), "accepted");
  for (const char* text : {"one\\ntwo", "one\\rtwo"})
    EXPECT_TRUE(
        contains(refusal(fmt::format("[print]\njob_name = \"{}\"\n", text)), "text of one line"));
}

// Twelve numbers are two keyframes only if each row has six.
TEST_F(JobFile, RowsOfAWayHaveSixNumbersEach) {
  EXPECT_EQ(refusal("path = [[0, 0, 0, 0, 0, 0], [9, 0, 0, 0, 0, 0]]\n"), "accepted");
  EXPECT_TRUE(contains(refusal("path = [[0, 0, 0, 0, 0], [9, 0, 0, 0, 0, 0, 0]]\n"),
                       "rows of six numbers"));
}

// A job's folder may be moved: its files are named from there.
TEST_F(JobFile, NamesFilesFromWhereItLies) {
  JobConfig config;
  config.model = folder_ / "a.obj";
  config.object.load.texture = folder_ / "pictures/a.png";
  config.dips.resize(1);
  config.dips[0].correction = folder_ / "dip-1/correction.json";
  const std::string text = job_file(config, folder_);
  EXPECT_TRUE(contains(text, "texture = \"pictures/a.png\"")) << text;
  EXPECT_TRUE(contains(text, "correction = \"dip-1/correction.json\"")) << text;
  EXPECT_EQ(text.find(folder_.string()), std::string::npos) << text;
}

// What was planned is not planned anew by whoever prints it.
TEST_F(JobFile, DoesNotAskForMoreDipsThanItNames) {
  JobConfig config;
  config.model = folder_ / "a.obj";
  config.plan.dips = 5;
  config.dips.resize(2);
  EXPECT_EQ(read(job_file(config, folder_)).plan.dips, 0);
}

TEST_F(JobFile, SaysOfARunOnlyWhatItIsToldTo) {
  JobConfig config;
  config.threads = 3;
  EXPECT_EQ(read(job_file(config, folder_)).threads, 0);
  EXPECT_EQ(read(job_file(config, folder_, {"run.threads"})).threads, 3);
}

TEST_F(JobFile, IsRefusedWhereItIsWrong) {
  EXPECT_TRUE(contains(refusal("[[dip]]\ndepth = 3\n"), "did you mean"));
  EXPECT_TRUE(contains(refusal("[[dip]]\ndepth = 3\n"), "job.toml:2"));
  EXPECT_TRUE(contains(refusal("[[dip]]\nlocked = 1\n"), "true or false"));
  EXPECT_TRUE(contains(refusal("[[dip]]\nrotate_deg = 7\n"), "three numbers"));
  EXPECT_TRUE(contains(refusal("[[dip]]\ndepth_mm = -1\n"), "job.toml:2"));
  // Named as the file does.
  EXPECT_TRUE(contains(refusal("[[dip]]\n[[dip]]\ndepth_mm = -1\n"),
                       "job.toml:3: [[dip]] 2: depth_mm must"));
  EXPECT_TRUE(contains(refusal("[[dip]]\nlocked = 1\n"), "job.toml:2: [[dip]] 1: locked must"));
  EXPECT_TRUE(contains(refusal("[[dip]]\nrotate_deg = 7\n"), ": [[dip]] 1: rotate_deg must"));
  EXPECT_TRUE(contains(refusal("[[artwork]]\n[[artwork]]\nopacity = 7\n"),
                       ": [[artwork]] 2: opacity must"));
  EXPECT_TRUE(contains(refusal("[[part]]\ncount = 0\n"), ": [[part]] 1: count must"));
  EXPECT_TRUE(contains(refusal("[dips]\nstep_mm = -1\n"), ": dips.step_mm must"));
  std::string many;
  for (int i = 0; i < 25; ++i) many += "[[dip]]\n";
  EXPECT_TRUE(contains(refusal(many), "at most 24"));
}

TEST(Auto, StandsForPoseAndDepth) {
  JobConfig config;
  apply_settings(config, {parse_set("object.rotate_deg=auto"), parse_set("dip.depth_mm=auto")});
  EXPECT_TRUE(config.plan.find_pose && config.plan.find_depth);
  EXPECT_EQ(std::get<std::string>(find_parameter("dip.depth_mm", "").get(config)), "auto");
  apply_settings(config, {parse_set("object.rotate_deg=1,2,3"), parse_set("dip.depth_mm=4")});
  EXPECT_FALSE(config.plan.find_pose || config.plan.find_depth);
  EXPECT_EQ(config.design.trajectory.depth_mm, 4);
}

}  // namespace
}  // namespace hydrodip
