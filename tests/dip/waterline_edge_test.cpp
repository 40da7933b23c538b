// The waterline's direction at an object's edges: what the film does must not jump there.
#include <gtest/gtest.h>

#include "dip/waterline.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

struct Block {
  shapes::Shape shape = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 6));
  Waterline line{shape.positions, shape.triangles, 2};
  Block() { line.move_to(Moment::at_depth(3)); }
  // The direction where a way from the middle leaves the block, `beside` mm beside its corner.
  Vec2 leaving(double beside) const {
    const auto out = line.exit(Vec2(0, 0), 2 * Vec2(10 + beside, 10 - beside));
    EXPECT_TRUE(out);
    return out ? out->outward : Vec2::Zero();
  }
  // And of the closest point to one that lies outside of the corner.
  Vec2 nearest(double beside) const {
    const auto point = line.closest(Vec2(10.5 + beside, 10.5 - beside), 2);
    EXPECT_TRUE(point);
    return point ? point->outward : Vec2::Zero();
  }
};

TEST(WaterlineEdge, DirectionsAHairToEitherSideAreNearlyTheSame) {
  const Block block;
  const double hair = 1e-4;
  EXPECT_LT((block.leaving(hair) - block.leaving(-hair)).norm(), 0.01);
  EXPECT_LT((block.nearest(hair) - block.nearest(-hair)).norm(), 0.01);
  // In the middle they look along the corner's bisector, by symmetry.
  EXPECT_LT((block.leaving(hair) - Vec2(1, 1).normalized()).norm(), 0.01);
}

TEST(WaterlineEdge, TurnsContinuouslyFromOneFaceToTheOther) {
  const Block block;
  double before = -1;
  for (double beside = -0.5; beside <= 0.5; beside += 1e-3) {
    const Vec2 out = block.leaving(beside);
    const double angle = std::atan2(out.y(), out.x());
    if (before >= 0) {
      EXPECT_LT(std::abs(angle - before), 0.1) << beside;
    }
    before = angle;
  }
  // Away from the edge each face has its own.
  EXPECT_LT((block.leaving(0.5) - Vec2(1, 0)).norm(), 1e-12);
  EXPECT_LT((block.leaving(-0.5) - Vec2(0, 1)).norm(), 1e-12);
}

}  // namespace
}  // namespace hydrodip
