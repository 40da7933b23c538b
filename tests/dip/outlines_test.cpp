#include "dip/outlines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exact/shapes.h"

namespace hydrodip {
namespace {

double length_of(const std::vector<OutlineSegment>& outline) {
  double length = 0;
  for (const auto& [a, b] : outline) length += (b - a).norm();
  return length;
}

// A box that leans over is cut along a rectangle of its width by what the plane cuts of the rest.
TEST(DipOutlines, OfABoxAreItsPlanFromTheFirstMillimetreToTheEnd) {
  const shapes::Shape box = shapes::box(Vec3(-10, -5, 0), Vec3(20, 8, 6));
  const DipOutlines outlines =
      dip_outlines(Trajectory::straight_down(4), box.positions, box.triangles);
  for (const auto& outline : {outlines.first_touch, outlines.full_depth}) {
    EXPECT_NEAR(length_of(outline), 2 * (30 + 13), 1e-9);
    for (const auto& [a, b] : outline)
      for (const Vec2& p : {a, b})
        EXPECT_NEAR(std::min({std::abs(p.x() + 10), std::abs(p.x() - 20), std::abs(p.y() + 5),
                              std::abs(p.y() - 8)}),
                    0, 1e-9);
  }
}

TEST(DipOutlines, OfABoxBelowTheWaterAreWhereItWasWidest) {
  const shapes::Shape box = shapes::box(Vec3(-10, -5, 0), Vec3(20, 8, 6));
  const DipOutlines outlines =
      dip_outlines(Trajectory::straight_down(7), box.positions, box.triangles);
  EXPECT_NEAR(length_of(outlines.full_depth), 2 * (30 + 13), 1e-9);
}

// What is shifted in the bath on its way in has its outline where it ends.
TEST(DipOutlines, FollowTheWayIn) {
  const shapes::Shape box = shapes::box(Vec3(-10, -5, 0), Vec3(20, 8, 6));
  Keyframe end;
  end.lower_mm = 4;
  end.shift_x_mm = 8;
  const DipOutlines outlines =
      dip_outlines(Trajectory::through({Keyframe(), end}), box.positions, box.triangles);
  Box2 at_end;
  for (const auto& [a, b] : outlines.full_depth)
    for (const Vec2& p : {a, b}) at_end.add(p);
  EXPECT_LT((at_end.min - Vec2(-2, -5)).norm(), 1e-6);
  EXPECT_LT((at_end.max - Vec2(28, 8)).norm(), 1e-6);
  Box2 at_touch;
  for (const auto& [a, b] : outlines.first_touch)
    for (const Vec2& p : {a, b}) at_touch.add(p);
  EXPECT_GT(at_touch.min.x(), -10);
  EXPECT_LT(at_touch.min.x(), -7);
}

}  // namespace
}  // namespace hydrodip
