// The way from an attached vertex to the contact line, unrolled: exact lengths over creases, on
// walls, along the line, and the slopes that they follow from.
#include "dip/foot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

// Rising along +x: at 30 degrees up to x = 10, at 60 degrees from there on.
struct TwoSlopes {
  double first = std::tan(30 * kDegree), last = std::tan(60 * kDegree), crease = 10;
  double height(double x) const {
    return x <= crease ? first * x : first * crease + last * (x - crease);
  }
  // From (x, y) to the contact line at (to_x, to_y), in which the object faces +x.
  Vec2 way(double x, double y, double to_x, double to_y, double z_stretch) const {
    const Waterline::Point to{Vec2(to_x, to_y), Vec2(1, 0), to_x <= crease ? first : last};
    return unrolled(Vec3(x, y, height(x)), Vec2(1, 0), x < crease ? first : last, to, height(to_x),
                    z_stretch);
  }
};

TEST(Unrolled, OverACreaseIsTheSumOfItsTwoSides) {
  const TwoSlopes wedge;
  for (const double z_stretch : {1.0, 0.65})
    for (const double from : {2.0, 7.0, 9.9})
      for (const double to : {10.1, 11.0, 13.0}) {
        const double below =
            std::hypot(wedge.crease - from, z_stretch * wedge.first * (wedge.crease - from));
        const double above =
            std::hypot(to - wedge.crease, z_stretch * wedge.last * (to - wedge.crease));
        const Vec2 way = wedge.way(from, 3, to, 3, z_stretch);
        EXPECT_NEAR(way.x(), below + above, 1e-12);
        EXPECT_NEAR(way.y(), 0, 1e-12);
      }
}

TEST(Unrolled, OnOneSideOfTheCreaseIsTheChord) {
  const TwoSlopes wedge;
  for (const auto& [from, to] : {std::pair{2.0, 8.0}, {11.0, 14.0}}) {
    const double rise = wedge.height(to) - wedge.height(from);
    EXPECT_NEAR(wedge.way(from, 0, to, 0, 0.65).x(), std::hypot(to - from, 0.65 * rise), 1e-12);
  }
}

// Along the contact line nothing is unrolled.
TEST(Unrolled, KeepsWhatLeadsAlongTheLine) {
  const TwoSlopes wedge;
  const Vec2 straight = wedge.way(7, 0, 12, 0, 0.65), aslant = wedge.way(7, 0, 12, 2.5, 0.65);
  EXPECT_NEAR(aslant.x(), straight.x(), 1e-12);
  EXPECT_NEAR(aslant.y(), 2.5, 1e-12);
}

// Up a wall the run is nothing and the length is the scaled rise.
TEST(Unrolled, UpAWallIsItsHeight) {
  const Waterline::Point to{Vec2(5, 0), Vec2(1, 0), kWall};
  const Vec2 way = unrolled(Vec3(5, 0, 1), Vec2(1, 0), kWall, to, 4, 0.65);
  EXPECT_NEAR(way.x(), 0.65 * 3, 1e-5);
  // From a floor 2 mm before it: the floor, then the wall.
  const Vec2 over = unrolled(Vec3(3, 0, 1), Vec2::Zero(), 0, to, 4, 0.65);
  EXPECT_NEAR(over.x(), 2 + 0.65 * 3, 1e-5);
}

// The object's slope, from its normal: down and outward on a surface that rises.
TEST(Steepness, IsRiseOverRun) {
  for (const double degrees : {10.0, 45.0, 80.0}) {
    const double angle = degrees * kDegree;
    const Vec3 normal(std::sin(angle), 0, -std::cos(angle));
    EXPECT_NEAR(steepness_along(normal, Vec2(1, 0)), std::tan(angle), 1e-9);
    EXPECT_NEAR(steepness_along(normal, Vec2(-1, 0)), -std::tan(angle), 1e-9);
    EXPECT_NEAR(steepness_along(normal, Vec2(0, 1)), 0, 1e-12);
  }
  EXPECT_EQ(steepness_along(Vec3(1, 0, 0), Vec2(1, 0)), kWall);
}

// Film that was laid without strain has its ghost where the vertex is, unrolled; film laid loosely
// reaches further back, by the strain, but never by more than half of the way.
TEST(Ghost, LiesAsFarBackAsTheFilmThatWasLaid) {
  Foot foot;
  foot.place = Vec2(7, 1);
  foot.way = foot.laid = Vec2(2, 0.5);
  place_ghost(foot);
  EXPECT_LT((foot.ghost - Vec2(5, 0.5)).norm(), 1e-12);
  foot.laid = Vec2(2.2, 0.5);
  place_ghost(foot);
  EXPECT_LT((foot.ghost - Vec2(4.8, 0.5)).norm(), 1e-12);
  foot.laid = foot.way;
  foot.ghost_gradient.now = 1.25 * Mat2::Identity();  // du/dX: film that is squeezed to 0.8
  place_ghost(foot);
  EXPECT_LT((foot.ghost - (Vec2(7, 1) - 0.8 * foot.way)).norm(), 1e-12);
  foot.laid = Vec2(40, 0);
  foot.ghost_gradient.now = Mat2::Identity();
  place_ghost(foot);
  EXPECT_NEAR((Vec2(7, 1) - foot.ghost - foot.way).norm(), 0.5 * foot.way.norm(), 1e-12);
}

// What changes evenly along the way is followed without a lag, however long the steps.
TEST(GhostGradient, FollowsWhatChangesEvenly) {
  for (const double step_mm : {0.02, 0.1, 0.5}) {
    GhostGradient ghost;
    for (double way_mm = step_mm; way_mm < 2; way_mm += step_mm) {
      const Mat2 expected = (1 + 0.2 * way_mm) * Mat2::Identity();
      // Before the first step nothing is known of any change.
      if (way_mm == step_mm) ghost.now = expected - 0.2 * step_mm * Mat2::Identity();
      ghost.follow(expected, step_mm, way_mm, way_mm / 2);
      EXPECT_LT((ghost.now - expected).norm(), 1e-9) << way_mm << " mm in steps of " << step_mm;
    }
  }
}

// Film whose gradient answers to an error of the ghost's with the foot's share of its way and a
// quarter more, over the last fifth: what the error becomes is a matter of the way, not of steps.
TEST(GhostGradient, KeepsAnErrorThatFeedsItselfInBounds) {
  for (const int steps : {20, 200, 2000}) {
    constexpr double kWay_mm = 2, kFeedback = 1.25, kError = 1e-3;
    const double step_mm = 0.2 * kWay_mm / steps;
    GhostGradient ghost;
    ghost.now = kError * Mat2::Identity();
    for (int step = 1; step <= steps; ++step) {
      const double way_mm = 0.8 * kWay_mm + step * step_mm;
      const double share = way_mm / kWay_mm;
      ghost.follow(kFeedback * share * ghost.now, step_mm, way_mm, share);
    }
    EXPECT_LT(ghost.now(0, 0), 3 * kError) << steps << " steps";
  }
}

TEST(GhostGradient, WaitsWhileTheFootStands) {
  GhostGradient ghost;
  ghost.follow(2 * Mat2::Identity(), 0.1, 1, 0.5);
  ghost.follow(3 * Mat2::Identity(), 0, 1, 0.5);
  EXPECT_EQ(ghost.now, 3 * Mat2::Identity());  // far from where it goes: as expected
  ghost.follow(4 * Mat2::Identity(), 0, 1, 0.95);
  EXPECT_EQ(ghost.now, 3 * Mat2::Identity());
}

TEST(Gradient, IsExtrapolatedByThePresentStep) {
  Gradient gradient;
  gradient.advance(2 * Mat2::Identity());
  gradient.advance(3 * Mat2::Identity());
  EXPECT_LT((gradient.next(1) - 4 * Mat2::Identity()).norm(), 1e-15);
  EXPECT_LT((gradient.next(0.5) - 3.5 * Mat2::Identity()).norm(), 1e-15);
}

TEST(Gradient, IsUsableUnlessFlatTurnedOverOrHuge) {
  EXPECT_TRUE(usable_gradient(Mat2::Identity()));
  EXPECT_FALSE(usable_gradient(-Vec2(1, -1).asDiagonal().toDenseMatrix()));
  EXPECT_FALSE(usable_gradient(Vec2(1, 0).asDiagonal().toDenseMatrix()));
  EXPECT_FALSE(usable_gradient(101 * Mat2::Identity()));
  EXPECT_FALSE(usable_gradient(NAN * Mat2::Identity()));
}

}  // namespace
}  // namespace hydrodip
