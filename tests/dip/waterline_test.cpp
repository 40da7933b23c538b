#include "dip/waterline.h"

#include <gtest/gtest.h>

#include <random>

#include "exact/shapes.h"
#include "object/surface.h"

namespace hydrodip {
namespace {

TEST(Waterline, OfABoxIsItsPlan) {
  const shapes::Shape box = shapes::box(Vec3(-10, -5, 1), Vec3(20, 8, 6));
  Waterline line(box.positions, box.triangles, 2);
  line.move_to(Moment::at_depth(0.5));
  EXPECT_TRUE(line.empty());
  EXPECT_FALSE(line.exit(Vec2(0, 0), Vec2(100, 0)));
  EXPECT_FALSE(line.closest(Vec2(0, 0), 100));
  for (const double level : {2.0, 5.5}) {
    line.move_to(Moment::at_depth(level));
    ASSERT_FALSE(line.empty());
    const auto out = line.exit(Vec2(0, 1), Vec2(50, 1));
    ASSERT_TRUE(out);
    EXPECT_LT((out->position - Vec2(20, 1)).norm(), 1e-12);
    EXPECT_LT((out->outward - Vec2(1, 0)).norm(), 1e-12);
    EXPECT_GT(out->steepness, 1e5);  // a wall
    const auto near = line.closest(Vec2(3, 7), 3);
    ASSERT_TRUE(near);
    EXPECT_LT((near->position - Vec2(3, 8)).norm(), 1e-12);
    EXPECT_LT((near->outward - Vec2(0, 1)).norm(), 1e-12);
    EXPECT_FALSE(line.closest(Vec2(3, 1), 3));  // 6 mm and more from every wall
  }
  line.move_to(Moment::at_depth(7));
  EXPECT_TRUE(line.empty());
}

// Into the object is not out of it, and the end of the way counts.
TEST(Waterline, ExitLooksOutwardsOnly) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 6));
  Waterline line(box.positions, box.triangles, 3);
  line.move_to(Moment::at_depth(3));
  EXPECT_FALSE(line.exit(Vec2(-20, 1), Vec2(0, 1)));  // enters
  EXPECT_FALSE(line.exit(Vec2(0, 1), Vec2(9, 1)));    // stays inside
  const auto through = line.exit(Vec2(-20, 1), Vec2(20, 1));
  ASSERT_TRUE(through);
  EXPECT_LT((through->position - Vec2(10, 1)).norm(), 1e-12);
}

// Of several ways out the first counts, from whichever side it comes.
TEST(Waterline, ExitIsTheFirstOfSeveral) {
  shapes::Shape row = shapes::box(Vec3(-30, -5, 0), Vec3(-20, 5, 6));
  row.append(shapes::box(Vec3(-4, -5, 0), Vec3(4, 5, 6)));
  row.append(shapes::box(Vec3(20, -5, 0), Vec3(30, 5, 6)));
  Waterline line(row.positions, row.triangles, 2);
  line.move_to(Moment::at_depth(3));
  for (const double side : {-1.0, 1.0}) {
    const auto out = line.exit(side * Vec2(-25, 0.3), side * Vec2(40, 1));
    ASSERT_TRUE(out);
    EXPECT_NEAR(out->position.x(), side * -20, 1e-12);
  }
}

TEST(Waterline, OfAConeIsACircleWithItsSlope) {
  for (const double tan_theta : {0.3, 1.0, 4.0}) {
    const shapes::Shape cone = shapes::cone(20, tan_theta, 40, 720);
    Waterline line(cone.positions, cone.triangles, 1.5);
    for (const double radius : {3.1, 9.7, 17.3}) {
      line.move_to(Moment::at_depth(radius * tan_theta));
      for (int i = 0; i < 50; ++i) {
        const double angle = 0.1 + i * 0.13;
        const Vec2 out(std::cos(angle), std::sin(angle));
        // A polygon's sagitta: radius (1 - cos(pi / 720)).
        const double sagitta = radius * 1e-5;
        const auto exit = line.exit(0.2 * radius * out, 1.5 * radius * out);
        ASSERT_TRUE(exit);
        EXPECT_NEAR(exit->position.norm(), radius, sagitta);
        EXPECT_NEAR(cross2(exit->position, out), 0, 1e-9);
        EXPECT_LT((exit->outward - out).norm(), 0.01);
        EXPECT_NEAR(exit->steepness, tan_theta, 1e-4 * tan_theta);
        const auto near = line.closest(0.9 * radius * out, 0.2 * radius);
        ASSERT_TRUE(near);
        EXPECT_NEAR((near->position - 0.9 * radius * out).norm(), 0.1 * radius, sagitta);
        EXPECT_FALSE(line.closest(0.9 * radius * out, 0.09 * radius));
      }
    }
  }
}

// Levels exactly at vertices, edges and faces: the line stays closed, so that every way out of the
// object meets it once.
TEST(Waterline, HasNoGapsAtVertexLevels) {
  const shapes::Shape cone = shapes::cone(20, 1, 20, 24);  // rings of vertices at every whole level
  Waterline line(cone.positions, cone.triangles, 1);
  for (int level = 1; level <= 19; ++level) {
    line.move_to(Moment::at_depth(level));
    for (int i = 0; i < 96; ++i) {
      const Vec2 out(std::cos(i * M_PI / 48), std::sin(i * M_PI / 48));  // through vertices, too
      const auto exit = line.exit(Vec2(0, 0), 25 * out);
      ASSERT_TRUE(exit) << level << " " << i;
      EXPECT_LE(exit->position.norm(), level + 1e-9);
      EXPECT_GE(exit->position.norm(), level * std::cos(M_PI / 24) - 1e-9);
    }
  }
}

TEST(Waterline, AtABoxsBottomAndTop) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 6));
  Waterline line(box.positions, box.triangles, 3);
  line.move_to(Moment::at_depth(0));  // touches only: nothing is below the water
  EXPECT_TRUE(line.empty());
  line.move_to(Moment::at_depth(6));  // up to its brim
  ASSERT_TRUE(line.exit(Vec2(0, 0.3), Vec2(30, 0.3)));
  EXPECT_NEAR(line.exit(Vec2(0, 0.3), Vec2(30, 0.3))->position.x(), 10, 1e-12);
}

// An overhang's waterline shrinks as the water rises.
TEST(Waterline, KnowsOverhangs) {
  const shapes::Shape sphere = shapes::revolve(
      [](double s) { return Vec2(10 * std::sin(M_PI * s), 10 - 10 * std::cos(M_PI * s)); }, 90,
      180);
  Waterline line(sphere.positions, sphere.triangles, 1);
  line.move_to(Moment::at_depth(15));
  const auto exit = line.exit(Vec2(0, 0), Vec2(20, 0.1));
  ASSERT_TRUE(exit);
  EXPECT_NEAR(exit->position.norm(), std::sqrt(75.0), 0.01);
  // Facets of 2 degrees: the slope is met within half of that, 4 / 57.3.
  EXPECT_NEAR(exit->steepness, -std::sqrt(3.0), 0.075);
}

// Points that float while the water rises: those that meet the object must not be ruled out, and
// most of the others should be.
TEST(Waterline, RulesOutOnlyWaysThatDoNotTouch) {
  std::mt19937 generator(3);
  const shapes::Shape all[] = {shapes::sphere_bowl(30, 28), shapes::cone(20, 0.7),
                               shapes::box(Vec3(-17, -9, 0), Vec3(12, 21, 16))};
  for (const shapes::Shape& shape : all) {
    const Surface surface(shape.positions, shape.triangles);
    Waterline line(shape.positions, shape.triangles, 1.5);
    std::uniform_real_distribution<double> plan(-35, 35), slide(-2, 2);
    long met = 0, ruled_out = 0;
    double before = -0.1;
    line.move_to(Moment::at_depth(before));
    for (const double level : {0.0, 0.1, 0.4, 3.0, 3.1, 7.0, 12.0, 13.0}) {
      line.move_to(Moment::at_depth(level));
      for (int n = 0; n < 4000; ++n) {
        const Vec2 a(plan(generator), plan(generator));
        const Vec2 b = a + Vec2(slide(generator), slide(generator));
        const Vec3 from(a.x(), a.y(), before), to(b.x(), b.y(), level);
        const bool meets = surface.is_hit(from, to - from, 0, 1);
        met += meets;
        ruled_out += !line.may_touch(a, b);
        EXPECT_TRUE(!meets || line.may_touch(a, b)) << from.transpose() << " to " << to.transpose();
      }
      before = level;
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(ruled_out, 20000);
  }
}

std::vector<Vec3> turned(const std::vector<Vec3>& positions, const Moment& moment) {
  std::vector<Vec3> result;
  result.reserve(positions.size());
  for (const Vec3& p : positions) result.push_back(moment.to_sinking(p));
  return result;
}

// On its way an object meets the water as one that was modelled like that, whichever moments came
// before; and no point that it met on its way was ruled out.
TEST(Waterline, OfAnyPathIsThatOfTheTurnedObject) {
  const shapes::Shape egg = shapes::revolve(
      [](double s) { return Vec2(6 * std::sin(M_PI * s), 10 - 10 * std::cos(M_PI * s)); }, 50, 60);
  const Surface surface(egg.positions, egg.triangles);
  const Travel travel(Trajectory::through({{.lower_mm = -2},
                                           {.lower_mm = 9, .shift_x_mm = 3, .turn_y_deg = 30},
                                           {.lower_mm = 4, .shift_x_mm = 1, .turn_y_deg = 90},
                                           {.lower_mm = 12, .turn_y_deg = 80, .turn_z_deg = 50}},
                                          Vec3(1, 0, 8)),
                      egg.positions, egg.triangles);
  Waterline line(egg.positions, egg.triangles, 1);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> plan(-15, 15), slide(-0.5, 0.5);
  Moment before = travel.at(0);
  line.move_to(before);
  long met = 0, ruled_out = 0;
  for (int n = 1; n <= 60; ++n) {
    const Moment moment = travel.at(travel.length_mm() * n / 60);
    line.move_to(moment);
    const std::vector<Vec3> positions = turned(egg.positions, moment);
    Waterline alone(positions, egg.triangles, 1);
    alone.move_to(Moment::at_depth(moment.level_mm));
    for (int m = 0; m < 300; ++m) {
      const Vec2 a(plan(generator), plan(generator));
      const auto there = line.closest(a, 5), as_well = alone.closest(a, 5);
      ASSERT_EQ(there.has_value(), as_well.has_value());
      if (there) {
        EXPECT_LT((there->position - as_well->position).norm(), 1e-9);
      }
      const Vec2 b = a + Vec2(slide(generator), slide(generator));
      const Vec3 from = before.to_object(Vec3(a.x(), a.y(), before.level_mm));
      const Vec3 to = moment.to_object(Vec3(b.x(), b.y(), moment.level_mm));
      const bool meets = surface.is_hit(from, to - from, 0, 1);
      met += meets;
      ruled_out += !line.may_touch(a, b);
      EXPECT_TRUE(!meets || line.may_touch(a, b));
    }
    before = moment;
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(ruled_out, 2000);
}

// In wrong units an object can be as large as it likes.
TEST(Waterline, OfSomethingHugeFitsIntoMemory) {
  const shapes::Shape box = shapes::box(Vec3(-4e6, -1e6, 0), Vec3(4e6, 1e6, 6));
  Waterline line(box.positions, box.triangles, 1);
  EXPECT_TRUE(line.empty());
}

}  // namespace
}  // namespace hydrodip
