#include "dip/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "dip/travel.h"
#include "dip/zoo_shapes.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

constexpr double kQuarterTurn_deg = 90;

void expect_at(const Trajectory& path, double t, const Vec3& on_object, const Vec3& in_bath) {
  EXPECT_LT((path.bath_from_object(t) * on_object - in_bath).norm(), 1e-12);
}

TEST(Trajectory, StraightDownOnlyLowers) {
  const Trajectory path = Trajectory::straight_down(12);
  EXPECT_TRUE(path.is_straight_down());
  EXPECT_EQ(path.depth_mm(), 12);
  expect_at(path, 0, Vec3(1, 2, 3), Vec3(1, 2, 3));
  expect_at(path, 0.25, Vec3(1, 2, 3), Vec3(1, 2, 0));
  expect_at(path, 1, Vec3(1, 2, 3), Vec3(1, 2, -9));
}

TEST(Trajectory, TurnsAboutThePivotAndThenShifts) {
  const Trajectory path = Trajectory::through(
      {{}, {.lower_mm = 5, .shift_x_mm = 1, .turn_y_deg = kQuarterTurn_deg}}, Vec3(10, 0, 2));
  EXPECT_FALSE(path.is_straight_down());
  expect_at(path, 0, Vec3(7, 8, 9), Vec3(7, 8, 9));
  expect_at(path, 1, Vec3(10, 0, 2), Vec3(11, 0, -3));
  expect_at(path, 1, Vec3(10, 0, 3), Vec3(12, 0, -3));  // about +y, z goes to x
  expect_at(path, 1, Vec3(11, 4, 2), Vec3(11, 4, -4));
}

TEST(Trajectory, TurnsAboutXFirstAndAboutZLast) {
  const Trajectory path =
      Trajectory::through({{}, {.turn_x_deg = kQuarterTurn_deg, .turn_z_deg = kQuarterTurn_deg}});
  expect_at(path, 1, Vec3(0, 1, 0), Vec3(0, 0, 1));  // y to z, which z leaves alone
  expect_at(path, 1, Vec3(0, 0, 1), Vec3(1, 0, 0));  // z to -y, and that to x
  expect_at(path, 1, Vec3(1, 0, 0), Vec3(0, 1, 0));
}

TEST(Trajectory, KeyframesAreEvenlySpread) {
  const Trajectory path =
      Trajectory::through({{}, {.lower_mm = 1}, {.lower_mm = 9}, {.lower_mm = 9, .turn_x_deg = 8}});
  EXPECT_DOUBLE_EQ(path.at(1.0 / 3).lower_mm, 1);
  EXPECT_DOUBLE_EQ(path.at(0.5).lower_mm, 5);
  EXPECT_DOUBLE_EQ(path.at(2.0 / 3).lower_mm, 9);
  EXPECT_DOUBLE_EQ(path.at(5.0 / 6).turn_x_deg, 4);
}

TEST(Trajectory, KnowsAWayStraightDownInPieces) {
  EXPECT_TRUE(Trajectory::through({{-3}, {1}, {4}, {4}, {9}}).is_straight_down());
  EXPECT_FALSE(Trajectory::through({{0}, {4}, {3}}).is_straight_down());
  EXPECT_FALSE(Trajectory::through({{1}, {4}}).is_straight_down());
  EXPECT_FALSE(Trajectory::through({{0, 1}, {4, 1}}).is_straight_down());
}

TEST(Trajectory, RefusesWhatIsNoPath) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Trajectory::through({}), InputError);
  EXPECT_THROW(Trajectory::through({{1}}), InputError);
  EXPECT_THROW(Trajectory::through({{}, {infinite}}), InputError);
  EXPECT_THROW(Trajectory::through({{}, {1}}, Vec3(0, infinite, 0)), InputError);
}

TEST(Trajectory, NoObjectGoesDeeperThanItsTop) {
  const shapes::Shape box = shapes::box(Vec3(-1, -1, 0), Vec3(1, 1, 5));
  EXPECT_EQ(make_trajectory({3.3}, box.positions).depth_mm(), 3.3);
  EXPECT_EQ(make_trajectory({99}, box.positions).depth_mm(), 5);
  EXPECT_EQ(make_trajectory({0}, box.positions).depth_mm(), 5);
  EXPECT_THROW(make_trajectory({-1}, box.positions), InputError);
  EXPECT_THROW(make_trajectory({std::nan("")}, box.positions), InputError);
}

// Whatever way it leans, an object that leans starts at the water and ends as deep as asked, in the
// middle of the film.
TEST(Trajectory, ALeaningObjectTouchesFirstAndGoesAsDeepAsAsked) {
  const shapes::Shape box = shapes::box(Vec3(-6, -4, 0), Vec3(6, 4, 30));
  for (const double toward : {0.0, 90.0, 200.0})
    for (const double roll : {0.0, 35.0}) {
      const Trajectory path = make_trajectory(
          {.depth_mm = 9, .tilt_deg = 20, .tilt_toward_deg = toward, .roll_deg = roll},
          box.positions);
      const auto lowest = [&](double t) {
        double low = 1e300;
        for (const Vec3& p : box.positions) low = std::min(low, (path.bath_from_object(t) * p).z());
        return low;
      };
      EXPECT_NEAR(lowest(0), 0, 1e-9);
      EXPECT_NEAR(lowest(1), -9, 1e-9);
      EXPECT_NEAR(lowest(0.5), -4.5, 0.01);
      const Vec3 up = path.bath_from_object(1).linear() * Vec3(0, 0, 1);
      EXPECT_NEAR(std::acos(up.z()), (20 + roll) * M_PI / 180, 1e-9);
      EXPECT_NEAR(up.x(), std::hypot(up.x(), up.y()) * std::cos(toward * M_PI / 180), 1e-9);
      EXPECT_NEAR(up.y(), std::hypot(up.x(), up.y()) * std::sin(toward * M_PI / 180), 1e-9);
    }
}

// What a leaning object covers of the film on its way has its middle in the film's, and an object
// that is asked to go deeper than it is high ends with its top at the water.
TEST(Trajectory, ALeaningObjectIsCentredAndGoesNoDeeperThanItsTop) {
  const shapes::Shape box = shapes::box(Vec3(-6, -4, 0), Vec3(10, 4, 30));
  for (const double toward : {0.0, 70.0})
    for (const double roll : {0.0, 35.0}) {
      const Trajectory path = make_trajectory(
          {.depth_mm = 99, .tilt_deg = 20, .tilt_toward_deg = toward, .roll_deg = roll},
          box.positions);
      Box2 covered;
      double top = -1e300, low = 1e300;
      const std::size_t pieces = path.keyframes().size() - 1;
      for (std::size_t n = 0; n <= pieces; ++n)
        for (const Vec3& p : box.positions) {
          const Vec3 at = path.bath_from_object(double(n) / double(pieces)) * p;
          covered.add(at.head<2>());
          if (n < pieces) continue;
          top = std::max(top, at.z());
          low = std::min(low, at.z());
        }
      EXPECT_LT((covered.min + covered.max).norm(), 1e-9);
      EXPECT_NEAR(top, 0, 1e-9);
      EXPECT_LT(low, -20);
    }
}

TEST(Trajectory, APathLeavesNothingElseToSay) {
  const shapes::Shape box = shapes::box(Vec3(-1, -1, 0), Vec3(1, 1, 5));
  const std::vector<Keyframe> path = {{}, {.lower_mm = 3, .turn_x_deg = 5}};
  EXPECT_EQ(make_trajectory({.path = path}, box.positions).depth_mm(), 3);
  EXPECT_THROW(make_trajectory({.depth_mm = 2, .path = path}, box.positions), InputError);
  EXPECT_THROW(make_trajectory({.path = path, .roll_deg = 2}, box.positions), InputError);
}

TEST(Travel, StraightDownIsTheDepth) {
  const shapes::Shape box = shapes::box(Vec3(-1, -1, 0), Vec3(1, 1, 50));
  const Travel travel(Trajectory::through({{-7}, {10}, {30}}), box.positions, box.triangles);
  EXPECT_EQ(travel.length_mm(), 30);
  EXPECT_EQ(travel.at(12.5).level_mm, 12.5);
  EXPECT_EQ(travel.at(12.5).to_object(Vec3(1, 2, 3)), Vec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(travel.at(20).t, 0.75);
}

TEST(Travel, BeginsAtTheFirstTouch) {
  const shapes::Shape ball = shapes::full_sphere(10, 40, 40);
  const Travel travel(
      Trajectory::through({{.lower_mm = -20}, {.lower_mm = 10, .shift_x_mm = 6, .turn_z_deg = 5}}),
      ball.positions, ball.triangles);
  const Moment touch = travel.at(0);
  double lowest = 1e9;
  for (const Vec3& p : ball.positions) lowest = std::min(lowest, touch.height(p));
  EXPECT_NEAR(lowest, 0, 1e-6);
  EXPECT_DOUBLE_EQ(travel.at(travel.length_mm()).t, 1);
}

// Whatever the path: in equal parts of its length, no wetted point moves further than one part.
TEST(Travel, NoWettedPointMovesFurtherThanAPart) {
  const shapes::Shape ball = shapes::full_sphere(12, 60, 60);
  const Trajectory path =
      Trajectory::through({{.lower_mm = -3},
                           {.lower_mm = 8, .turn_x_deg = 25},
                           {.lower_mm = 15, .shift_y_mm = 4, .turn_x_deg = 60},
                           {.lower_mm = 15, .turn_x_deg = 60, .turn_z_deg = 40}},
                          Vec3(2, 1, 5));
  const Travel travel(path, ball.positions, ball.triangles);
  const int parts = 200;
  double longest = 0;
  for (int n = 1; n <= parts; ++n) {
    const Moment a = travel.at(travel.length_mm() * (n - 1) / parts);
    const Moment b = travel.at(travel.length_mm() * n / parts);
    const auto in_bath = [](const Moment& m, const Vec3& p) {
      return Vec3(m.to_sinking(p) - Vec3(0, 0, m.level_mm));
    };
    for (const Vec3& p : ball.positions)
      if (a.height(p) < 0 || b.height(p) < 0)
        longest = std::max(longest, (in_bath(b, p) - in_bath(a, p)).norm());
  }
  EXPECT_LT(longest, 1.02 * travel.length_mm() / parts);
  EXPECT_GT(longest, 0.9 * travel.length_mm() / parts);
}

TEST(Travel, RefusesAPathThatBeginsInTheWaterOrStaysInTheAir) {
  const shapes::Shape box = shapes::box(Vec3(-1, -1, 0), Vec3(1, 1, 5));
  const auto travel = [&](std::vector<Keyframe> keyframes) {
    return Travel(Trajectory::through(std::move(keyframes)), box.positions, box.triangles);
  };
  EXPECT_THROW(travel({{.lower_mm = 1}, {.lower_mm = 3}}), InputError);
  // The first row turns one of its edges under water.
  EXPECT_THROW(travel({{.turn_x_deg = 20}, {.lower_mm = 3, .turn_x_deg = 20}}), InputError);
  EXPECT_THROW(travel({{.lower_mm = -5}, {.lower_mm = -1, .shift_x_mm = 3}}), InputError);
}

}  // namespace
}  // namespace hydrodip
