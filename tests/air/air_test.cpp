// Hollows whose air can be worked out by hand.
#include "air/air.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "air/cups.h"
#include "exact/shapes.h"
#include "object/append.h"

namespace hydrodip {
namespace {

using cups::kCup;
using cups::Kept;
using cups::kept_by_leaning_cup;
using cups::kRad;
using cups::kSegments;
using cups::mesh_of;
using cups::moved;
using cups::polygon_area;
using cups::polygon_outline;
using cups::turned;

TrappedAir air_of(const TriangleMesh& mesh, const Trajectory& way, int cells = 200000) {
  const Surface surface(mesh.positions, mesh.triangles);
  return find_air(mesh, surface, way, {cells}, RunContext());
}

TrappedAir air_of(const TriangleMesh& mesh) {
  return air_of(mesh, Trajectory::straight_down(mesh.bounds().max.z()));
}

double lid_area(const TrappedAir& air) {
  double area = 0;
  for (const Triangle& t : air.lids.triangles) {
    const Vec3& a = air.lids.positions[std::size_t(t[0])];
    const Vec3 twice = (air.lids.positions[std::size_t(t[1])] - a)
                           .cross(air.lids.positions[std::size_t(t[2])] - a);
    EXPECT_LT(twice.z(), 0) << "a lid faces down";
    area += 0.5 * twice.norm();
  }
  return area;
}

TEST(Air, ACupMouthDownKeepsAllOfIt) {
  for (const int cells : {20000, 200000, 1000000}) {
    const TriangleMesh cup = mesh_of(turned(kCup));
    const TrappedAir air = air_of(cup, Trajectory::straight_down(28), cells);
    ASSERT_EQ(air.pockets.size(), 1U) << cells;
    const AirPocket& pocket = air.pockets[0];
    EXPECT_NEAR(pocket.closed_at_mm, 0, 0.003);
    EXPECT_NEAR(pocket.volume_mm3, 25 * polygon_area(15), 1);
    EXPECT_NEAR(pocket.area_mm2, 25 * polygon_outline(15) + polygon_area(15), 0.5);
    EXPECT_NEAR(pocket.top.z(), 25, 1e-9);
    // Its walls all but level.
    EXPECT_GT(pocket.lets_out.value_or(Tilt{90, 0}).tilt_deg, 75);
    EXPECT_NEAR(lid_area(air), polygon_area(15), 1e-6);
  }
}

// A rim that a pose has turned, or single precision has rounded.
TEST(Air, ARimThatIsNotQuiteLevelChangesNothing) {
  for (const double noise_mm : {1e-9, 1e-6, 1e-4, 1.5e-3, 5e-3}) {
    TriangleMesh cup = mesh_of(turned(kCup));
    for (std::size_t v = 0; v < cup.positions.size(); ++v)
      if (cup.positions[v].z() < 1) cup.positions[v].z() += noise_mm * double(v * 7919 % 101) / 101;
    for (const int cells : {20000, 200000}) {
      const TrappedAir air = air_of(cup, Trajectory::straight_down(28), cells);
      ASSERT_EQ(air.pockets.size(), 1U) << noise_mm << " " << cells;
      EXPECT_NEAR(air.volume_mm3(), 25 * polygon_area(15), 6) << noise_mm;
      EXPECT_NEAR(air.area_mm2(), 25 * polygon_outline(15) + polygon_area(15), 1) << noise_mm;
      EXPECT_NEAR(lid_area(air), polygon_area(15), 0.1) << noise_mm;
    }
  }
}

// As modelling programs leave them: a tube, and a disc that is pushed into it.
TEST(Air, BodiesThatReachIntoEachOtherMakeOneHollow) {
  const TriangleMesh cup = mesh_of(turned(kCup));
  TriangleMesh bodies = mesh_of(turned({{18, 0}, {18, 28}, {15, 28}, {15, 0}}));
  append(bodies, mesh_of(turned({{0, 25}, {16.5, 25}, {16.5, 28}, {0, 28}})));
  for (const int cells : {20000, 200000}) {
    const TrappedAir one = air_of(cup, Trajectory::straight_down(28), cells);
    const TrappedAir two = air_of(bodies, Trajectory::straight_down(28), cells);
    ASSERT_EQ(two.pockets.size(), 1U);
    EXPECT_NEAR(two.volume_mm3(), one.volume_mm3(), 0.05 * one.volume_mm3()) << cells;
    // What lies within the other body is not told from what lies bare, triangle by triangle.
    EXPECT_NEAR(two.area_mm2(), one.area_mm2(), 0.15 * one.area_mm2()) << cells;
  }
}

TEST(Air, OnlyWhatWaterWouldReachCountsAsArea) {
  const TriangleMesh cup = mesh_of(turned(kCup));
  const TrappedAir air = air_of(cup, Trajectory::straight_down(10));
  ASSERT_EQ(air.pockets.size(), 1U);
  EXPECT_NEAR(air.area_mm2(), 10 * polygon_outline(15), 0.5);
  EXPECT_NEAR(air.volume_mm3(), 25 * polygon_area(15), 1);
}

TEST(Air, AHoleInTheBottomLetsItOut) {
  const TriangleMesh cup =
      mesh_of(turned({{1.5, 28}, {18, 28}, {18, 0}, {15, 0}, {15, 25}, {1.5, 25}}));
  EXPECT_TRUE(air_of(cup).pockets.empty());
}

// Water comes in until it closes the inner rim at its highest point.
TEST(Air, ATiltedCupFillsUpToItsRim) {
  for (const double tilt : {5.0, 20.0, 35.0}) {
    const Mat3 lean = Eigen::AngleAxisd(tilt * kRad, Vec3::UnitY()).toRotationMatrix();
    const TrappedAir air = air_of(moved(mesh_of(turned(kCup)), lean));
    ASSERT_EQ(air.pockets.size(), 1U) << tilt;
    const AirPocket& pocket = air.pockets[0];
    const Kept kept = kept_by_leaning_cup(tilt);
    EXPECT_NEAR(pocket.closed_at_mm, kept.closed_at_mm, 0.003) << tilt;
    EXPECT_NEAR(pocket.volume_mm3, kept.volume_mm3, 5) << tilt;
    EXPECT_NEAR(pocket.area_mm2, kept.area_mm2, 1) << tilt;
    EXPECT_NEAR(lid_area(air), polygon_area(15) / std::cos(tilt * kRad), 0.5) << tilt;
  }
}

// The same cup, leaned over by the way in instead.
TEST(Air, AWayThatTiltsIsAsGoodAsATiltedCup) {
  const TriangleMesh cup = mesh_of(turned(kCup));
  for (const double tilt : {0.001, 5.0, 20.0})
    for (const int cells : {20000, 50000, 200000, 600000}) {
      TrajectoryOptions options;
      options.tilt_deg = tilt;
      const TrappedAir air = air_of(cup, make_trajectory(options, cup.positions), cells);
      ASSERT_EQ(air.pockets.size(), 1U) << tilt << " " << cells;
      const Kept kept = kept_by_leaning_cup(tilt);
      EXPECT_NEAR(air.volume_mm3(), kept.volume_mm3, 5) << tilt << " " << cells;
      EXPECT_NEAR(air.area_mm2(), kept.area_mm2, 1) << tilt << " " << cells;
      EXPECT_NEAR(air.pockets[0].escapes_share, 0, 0.02);
    }
}

TEST(Air, AWayThatTiltsCountsNoMoreThanItsWaterReaches) {
  constexpr double kTilt_deg = 20, kDepth_mm = 22;
  const TriangleMesh cup = mesh_of(turned(kCup));
  TrajectoryOptions options;
  options.tilt_deg = kTilt_deg;
  options.depth_mm = kDepth_mm;
  const TrappedAir by_way = air_of(cup, make_trajectory(options, cup.positions));
  const Mat3 lean = Eigen::AngleAxisd(kTilt_deg * kRad, Vec3::UnitY()).toRotationMatrix();
  const TrappedAir by_pose = air_of(moved(cup, lean), Trajectory::straight_down(kDepth_mm));
  ASSERT_EQ(by_pose.pockets.size(), 1U);
  EXPECT_NEAR(by_way.area_mm2(), by_pose.area_mm2(), 1);
  EXPECT_LT(by_pose.area_mm2(), 0.9 * kept_by_leaning_cup(kTilt_deg).area_mm2);
}

TEST(Air, WhatTurnsOverUnderWaterLetsItsAirGo) {
  const TriangleMesh cup = mesh_of(turned(kCup));
  const TrappedAir air =
      air_of(cup, Trajectory::through({{}, {.lower_mm = 60}, {.lower_mm = 60, .turn_x_deg = 170}},
                                      Vec3(0, 0, 14)));
  ASSERT_EQ(air.pockets.size(), 1U);
  EXPECT_NEAR(air.volume_mm3(), 25 * polygon_area(15), 1);
  EXPECT_GT(air.pockets[0].escapes_share, 0.95);
  // Nor does it come back when the cup does.
  const TrappedAir back =
      air_of(cup, Trajectory::through(
                      {{}, {.lower_mm = 60}, {.lower_mm = 60, .turn_x_deg = 170}, {.lower_mm = 60}},
                      Vec3(0, 0, 14)));
  ASSERT_EQ(back.pockets.size(), 1U);
  EXPECT_GT(back.pockets[0].escapes_share, 0.95);
}

TEST(Air, HollowsWithinHollowsCloseOneByOne) {
  // A pipe in the cup, which reaches 5 mm further down.
  const TriangleMesh nested = moved(mesh_of(turned({{0, 28},
                                                    {18, 28},
                                                    {18, 0},
                                                    {15, 0},
                                                    {15, 25},
                                                    {8, 25},
                                                    {8, -5},
                                                    {6, -5},
                                                    {6, 25},
                                                    {0, 25}})),
                                    Mat3::Identity());
  const TrappedAir air = air_of(nested);
  ASSERT_EQ(air.pockets.size(), 2U);
  EXPECT_NEAR(air.pockets[0].closed_at_mm, 5, 0.003);
  EXPECT_NEAR(air.pockets[0].volume_mm3, 25 * (polygon_area(15) - polygon_area(8)), 2);
  EXPECT_NEAR(air.pockets[1].closed_at_mm, 0, 0.003);
  EXPECT_NEAR(air.pockets[1].volume_mm3, 30 * polygon_area(6), 2);
  EXPECT_NEAR(lid_area(air), polygon_area(15) - polygon_area(8) + polygon_area(6), 1e-6);
}

// The pipe ends above the cup's rim: water comes to neither.
TEST(Air, AHollowAboveTheWaterOfAnotherIsPartOfIt) {
  const TriangleMesh nested = mesh_of(turned({{0, 28},
                                              {18, 28},
                                              {18, 0},
                                              {15, 0},
                                              {15, 25},
                                              {8, 25},
                                              {8, 10},
                                              {6, 10},
                                              {6, 25},
                                              {0, 25}}));
  const TrappedAir air = air_of(nested);
  ASSERT_EQ(air.pockets.size(), 1U);
  EXPECT_NEAR(air.volume_mm3(), 25 * polygon_area(15) - 15 * (polygon_area(8) - polygon_area(6)),
              2);
}

TEST(Air, WhatIsOpenAboveKeepsNone) {
  // A ring, flat and upright, and a ball.
  const auto ring = shapes::revolve(
      [](double s) {
        const double a = 2 * std::numbers::pi * s - 0.5 * std::numbers::pi;
        return Vec2(20 + 6 * std::cos(a), 6 + 6 * std::sin(a));
      },
      48, kSegments);
  EXPECT_TRUE(air_of(mesh_of(ring)).pockets.empty());
  const Mat3 upright = Eigen::AngleAxisd(90 * kRad, Vec3::UnitX()).toRotationMatrix();
  EXPECT_TRUE(air_of(moved(mesh_of(ring), upright)).pockets.empty());
  const Mat3 mouth_up = Eigen::AngleAxisd(180 * kRad, Vec3::UnitX()).toRotationMatrix();
  EXPECT_TRUE(air_of(moved(mesh_of(turned(kCup)), mouth_up)).pockets.empty());
}

// A bowl of 20 mm radius as a sheet, mouth down; and the same with a hole of a fifth of a
// millimetre.
TEST(Air, SmallHolesInScansAreVentsAndSaidToBe) {
  const auto bowl = [](double hole_radius, double radius = 20) {
    return mesh_of(shapes::revolve(
        [&](double s) {
          const double a = 0.5 * std::numbers::pi * s;
          const double end = std::asin(hole_radius / radius);
          const double b = a * (1 - 2 * end / std::numbers::pi);
          return Vec2(radius * std::cos(b), radius * std::sin(b));
        },
        64, kSegments));
  };
  const TrappedAir whole = air_of(bowl(0));
  ASSERT_EQ(whole.pockets.size(), 1U);
  EXPECT_TRUE(whole.vents.empty());
  EXPECT_NEAR(whole.area_mm2(), 2 * std::numbers::pi * 400, 10);

  const TrappedAir pierced = air_of(bowl(0.1));
  ASSERT_GT(pierced.cell_mm, 0.4);
  EXPECT_TRUE(pierced.pockets.empty());
  ASSERT_EQ(pierced.vents.size(), 1U);
  EXPECT_NEAR(pierced.vents[0].width_mm, 0.2, 0.01);
  EXPECT_NEAR(pierced.vents[0].area_mm2, 2 * std::numbers::pi * 400, 10);
  EXPECT_NEAR((pierced.vents[0].at - Vec3(0, 0, 20)).norm(), 0, 0.02);

  // Of two the one that lets more out comes first.
  TriangleMesh both = bowl(0.1, 12);
  for (Vec3& p : both.positions) p.x() -= 40;
  append(both, bowl(0.1));
  const TrappedAir two = air_of(both);
  EXPECT_TRUE(two.pockets.empty());
  ASSERT_EQ(two.vents.size(), 2U);
  EXPECT_NEAR(two.vents[0].area_mm2, 2 * std::numbers::pi * 400, 15);
  EXPECT_NEAR(two.vents[1].area_mm2, 2 * std::numbers::pi * 144, 15);
}

// A shallow dish: air gets out once its rim's far side is the highest point of it.
TEST(Air, TheSmallestTiltThatLetsItOut) {
  // A cone 4 mm deep and 20 mm wide all round in a plate: it opens when the cone's side lies level.
  const TriangleMesh dish = mesh_of(turned({{0, 10}, {24, 10}, {24, 0}, {20, 0}, {0, 4}}));
  const TrappedAir air = air_of(dish);
  ASSERT_EQ(air.pockets.size(), 1U);
  EXPECT_NEAR(air.volume_mm3(), 4.0 / 3 * polygon_area(20), 2);
  ASSERT_TRUE(air.pockets[0].lets_out);
  EXPECT_NEAR(air.pockets[0].lets_out->tilt_deg, std::atan(4.0 / 20) / kRad, 3);
}

// Leaning already, it needs the less the more it leans, and to that side.
TEST(Air, ATiltThatLetsItOutIsToldToTheSideToWhichItLeans) {
  const TriangleMesh dish = mesh_of(turned({{0, 26}, {24, 26}, {24, 0}, {20, 0}, {0, 20}}));
  for (const double toward : {0.0, 90.0, 180.0, 270.0}) {
    const Vec3 axis(-std::sin(toward * kRad), std::cos(toward * kRad), 0);
    const Mat3 lean = Eigen::AngleAxisd(30 * kRad, axis).toRotationMatrix();
    const TrappedAir air = air_of(moved(dish, lean));
    ASSERT_EQ(air.pockets.size(), 1U);
    ASSERT_TRUE(air.pockets[0].lets_out);
    EXPECT_NEAR(air.pockets[0].lets_out->tilt_deg, 45 - 30, 3) << toward;
    EXPECT_EQ(air.pockets[0].lets_out->toward_deg, toward);
  }
}

// Where a leaning cup's water stands, its wall is wet below.
TEST(Air, OnlyAboveItsWaterAPocketKeepsDry) {
  const Mat3 lean = Eigen::AngleAxisd(20 * kRad, Vec3::UnitY()).toRotationMatrix();
  const TriangleMesh cup = moved(mesh_of(turned(kCup)), lean);
  const TrappedAir air = air_of(cup);
  ASSERT_EQ(air.pockets.size(), 1U);
  const double level = air.pockets[0].closed_at_mm;
  int dry = 0, wet = 0;
  for (std::size_t t = 0; t < cup.triangles.size(); ++t) {
    if (air.pocket_of[t] < 0) continue;
    const Triangle& corners = cup.triangles[t];
    for (int step = 0; step <= 10; ++step) {
      const Vec3 p =
          cup.positions[std::size_t(corners[0])] +
          0.1 * step *
              (cup.positions[std::size_t(corners[1])] - cup.positions[std::size_t(corners[0])]);
      if (std::abs(p.z() - level) < 0.01) continue;
      EXPECT_EQ(air.holds(int(t), p), p.z() > level) << p.transpose();
      (p.z() > level ? dry : wet) += 1;
    }
  }
  EXPECT_GT(dry, 0);
  EXPECT_GT(wet, 0);
}

// Turned about another point the same cup comes into the same water, later or earlier.
TEST(Air, ThePointThatAWayTurnsAboutChangesNothingOfItsAir) {
  const TriangleMesh cup = mesh_of(turned(kCup));
  constexpr double kTilt_deg = 20;
  const Kept kept = kept_by_leaning_cup(kTilt_deg);
  for (const double height : {0.0, 200.0}) {
    TrajectoryOptions options;
    options.pivot_mm = Vec3(0, 0, height);
    const double higher = height * (1 - std::cos(kTilt_deg * kRad));
    options.path = {{higher - 10, 0, 0, 0, kTilt_deg, 0}, {higher + 45, 0, 0, 0, kTilt_deg, 0}};
    const TrappedAir air = air_of(cup, make_trajectory(options, cup.positions));
    ASSERT_EQ(air.pockets.size(), 1U) << height;
    EXPECT_NEAR(air.volume_mm3(), kept.volume_mm3, 5) << height;
    EXPECT_NEAR(air.area_mm2(), kept.area_mm2, 1) << height;
  }
}

// A bore through the bottom that is narrower than the cells of a coarse look.
TEST(Air, ABoreThatCoarseCellsDoNotSeeLetsItOut) {
  for (const double radius : {0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0})
    for (const int cells : {500, 1000, 2000, 4000, 8000}) {
      const TriangleMesh cup =
          mesh_of(turned({{radius, 28}, {18, 28}, {18, 0}, {15, 0}, {15, 25}, {radius, 25}}));
      EXPECT_TRUE(air_of(cup, Trajectory::straight_down(28), cells).pockets.empty())
          << radius << " " << cells;
    }
}

// A gap between a cup's wall and its lid, lower than the cells of a coarse look.
TEST(Air, AGapThatCoarseCellsDoNotSeeLetsItOut) {
  const auto cup = [](double gap) {
    TriangleMesh mesh = mesh_of(turned({{15, 0}, {18, 0}, {18, 25}, {15, 25}}));
    append(mesh, mesh_of(turned({{0, 25 + gap}, {24, 25 + gap}, {24, 30}, {0, 30}})));
    return mesh;
  };
  for (const int cells : {500, 1000, 2000, 4000}) {
    const Trajectory way = Trajectory::straight_down(30);
    EXPECT_EQ(air_of(cup(-0.5), way, cells).pockets.size(), 1U) << cells;
    for (const double gap : {1.5, 2.0, 2.5})
      EXPECT_TRUE(air_of(cup(gap), way, cells).pockets.empty()) << gap << " " << cells;
  }
}

TEST(Air, TurningEverythingChangesNothing) {
  const TriangleMesh cup = mesh_of(turned(kCup));
  const Mat3 lean = Eigen::AngleAxisd(15 * kRad, Vec3::UnitY()).toRotationMatrix();
  const TrappedAir one = air_of(moved(cup, lean));
  const Mat3 about = Eigen::AngleAxisd(37 * kRad, Vec3::UnitZ()).toRotationMatrix();
  const TrappedAir other = air_of(moved(cup, about * lean));
  ASSERT_EQ(other.pockets.size(), 1U);
  EXPECT_NEAR(one.volume_mm3(), other.volume_mm3(), 1);
  EXPECT_NEAR(one.area_mm2(), other.area_mm2(), 1);
}

}  // namespace
}  // namespace hydrodip
