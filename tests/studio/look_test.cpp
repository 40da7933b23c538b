// What is shown of a dip, without a server.
#include "studio/look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "base/file.h"
#include "samples/samples.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class LookTest : public testing::Test {
 protected:
  LookTest() {
    write_sample("box", make_sample("box"), folder_.path());  // 40 x 40 x 15 mm
    job_.model = folder_ / "box.obj";
    job_.design.film.width_mm = job_.design.film.height_mm = 120;
    job_.design.film.elements = 800;
    job_.design.dip.step_mm = 1;
    job_.design.air.cells = 0;
    job_.design.dpi = 72;
    job_.design.trajectory.depth_mm = 2;
  }

  Look look(std::size_t dip = 0, const std::vector<std::string>& known = {}) {
    return look_at_dip(workspace_, job_, dip, LookQuality::kSketch, known, RunContext());
  }
  // The problem that there is; of no code: none.
  Problem problem(std::size_t dip = 0) {
    try {
      look(dip);
    } catch (const ProblemFound& found) {
      return found.problem;
    }
    return {};
  }

  TemporaryFolder folder_;
  Workspace workspace_;
  JobConfig job_;
};

TEST_F(LookTest, ADipIsMadeAsItsTableSays) {
  job_.dips.resize(3);
  job_.dips[0].depth_mm = 5;
  job_.dips[1].path = {{}, {.lower_mm = 4}};
  job_.plan.find_pose = true;
  EXPECT_EQ(config_of_dip(job_, 0).design.trajectory.depth_mm, 5);
  const JobConfig second = config_of_dip(job_, 1);
  EXPECT_EQ(second.design.trajectory.path.size(), 2U);
  EXPECT_EQ(make_trajectory(second.design.trajectory, {{0, 0, 0}, {0, 0, 15}}).depth_mm(), 4);
  EXPECT_EQ(config_of_dip(job_, 2).design.trajectory.depth_mm, 2);
  EXPECT_TRUE(config_of_dip(job_, 0).dips.empty());
  EXPECT_FALSE(config_of_dip(job_, 0).plan.find_pose);
  job_.plan.find_pose = false;
  EXPECT_NEAR(look(0).made->dipped.film->depth_mm, 5, 1e-9);
}

TEST_F(LookTest, ACorrectionMovesThatDipAlone) {
  write_file(folder_ / "c.json", R"({"schema_version": 1, "samples": [],
    "grid": {"first_mm": [-60, -60], "pitch_mm": 120, "nx": 2, "ny": 2,
      "move_mm": [[3, 0], [3, 0], [3, 0], [3, 0]]},
    "of": {"model": {"path": "", "sha256": "", "shape_sha256": ""},
      "to_posed": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "size_mm": [40, 40, 15], "depth_mm": 2,
      "film": {"width_mm": 120, "height_mm": 120, "margin_mm": 10, "swelling_x": 1, "swelling_y": 1},
      "material": {"z_stretch": 1, "poisson": 0.5, "ink_stiffness_ratio": 1}}})");
  job_.dips.resize(2);
  job_.dips[1].correction = folder_ / "c.json";
  EXPECT_EQ(config_of_dip(job_, 0).design.film.correction, nullptr);
  const auto field = config_of_dip(job_, 1).design.film.correction;
  ASSERT_NE(field, nullptr);
  EXPECT_LT((field->at({0, 0}) - Vec2(3, 0)).norm(), 1e-9);
}

TEST_F(LookTest, ASizeThatNobodyDipsIsAskedForUnlessItWasSaid) {
  EXPECT_EQ(problem().code, "");
  Object box = make_sample("box");
  for (Vec3& p : box.positions) p *= 30;  // 1.2 m
  write_sample("box", box, folder_.path());
  const Problem large = problem();
  EXPECT_EQ(large.code, "input");
  EXPECT_TRUE(large.text.starts_with("Is it really 1.2e+03 mm large?")) << large.text;
  EXPECT_EQ(large.mends.size(), 3U);
  job_.object.pose.size_mm = 40;
  EXPECT_EQ(problem().code, "");
  // Said, it is only too large.
  job_.object.pose.size_mm = 0;
  job_.object.load.units = "mm";
  EXPECT_TRUE(problem().text.starts_with("Too large: ")) << problem().text;
}

TEST_F(LookTest, WhatIsLeftOpenIsNotShownOtherwise) {
  job_.plan.find_depth = true;
  EXPECT_EQ(problem().mends.size(), 2U);
  job_.plan.find_depth = false;
  job_.plan.find_pose = true;
  EXPECT_EQ(problem().mends.size(), 2U);
  // Of several dips each leaves its own open, and depths are what a person says.
  job_.dips.resize(2);
  job_.dips[1].find_rotation = true;
  EXPECT_EQ(problem(0).code, "");
  EXPECT_EQ(problem(1).mends.size(), 1U);
}

TEST_F(LookTest, AWarningStandsOnce) {
  // A picture on the side that gets no film.
  ArtworkLayer& layer = job_.object.artwork.emplace_back();
  layer.text = "Hi";
  layer.toward = Vec3(0, 0, -1);
  const std::vector<std::string> alone = look().warnings;
  EXPECT_EQ(look().dry.size(), 1U);
  ASSERT_EQ(std::ranges::count(alone, look().dry.at(0).told), 1);
  // Known already.
  const std::vector<std::string> again = look(0, alone).warnings;
  EXPECT_EQ(again, alone);
  // Of several dips another one may bring film there.
  job_.dips.resize(2);
  const Look first = look();
  EXPECT_EQ(first.dry.size(), 1U);
  EXPECT_EQ(std::ranges::count(first.warnings, first.dry.at(0).told), 0);
}

// How large an object is in its file does not matter where its size is said.
TEST_F(LookTest, DipsTogetherAreThoseOfTheObjectAtItsSize) {
  job_.object.pose.size_mm = 40;
  job_.dips.resize(2);
  job_.dips[0].rotate_deg = Vec3(0, 0, 0);
  job_.dips[0].depth_mm = 2;
  job_.dips[1].rotate_deg = Vec3(180, 0, 0);
  job_.dips[1].depth_mm = 2;
  const auto gained = [&] {
    Workspace workspace;
    const Report report = look_at_dips(workspace, job_, 64, RunContext()).report;
    return std::array{report.dips.at(0).gained_share, report.dips.at(1).gained_share};
  };
  const auto as_it_is = gained();
  EXPECT_NEAR(as_it_is[0], 1600 / 5600.0, 0.05);
  EXPECT_GT(as_it_is[1], 0.2);
  Object box = make_sample("box");
  for (Vec3& p : box.positions) p *= 8;
  write_sample("box", box, folder_.path());
  EXPECT_EQ(gained(), as_it_is);
}

}  // namespace
}  // namespace hydrodip
