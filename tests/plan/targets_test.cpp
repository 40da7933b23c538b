#include "plan/targets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

TEST(Targets, StandForTheSurface) {
  const Object sphere = make_sample("sphere");
  const Targets targets = spread_targets(sphere, 2000);
  ASSERT_EQ(targets.list.size(), 2000U);
  const double radius = 0.5 * sphere.bounds().size().z();
  EXPECT_NEAR(targets.area / (4 * M_PI * radius * radius), 1, 0.02);
  EXPECT_NEAR(targets.weight, targets.area, 1e-9 * targets.area);
  // Half of them in either half, in every direction.
  const Vec3 center = sphere.bounds().center();
  for (int axis = 0; axis < 3; ++axis) {
    double above = 0;
    for (const Target& t : targets.list) {
      above += t.position[axis] > center[axis] ? 1 : 0;
      EXPECT_GT((t.position - center).normalized().dot(t.normal), 0.99);
    }
    EXPECT_NEAR(above / 2000, 0.5, 0.02);
  }
}

TEST(Targets, AreNoneOnNothing) {
  EXPECT_TRUE(spread_targets({}, 100).list.empty());
  EXPECT_EQ(spread_targets({}, 100).area, 0);
}

class HalfPainted : public Paint {
 public:
  explicit HalfPainted(const TriangleMesh& mesh) : Paint({1, 1, 1, 1}), mesh_(mesh) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    return position_at(mesh_, point).x() > mesh_.bounds().center().x()
               ? LinearColor{0.1F, 0.1F, 0.1F, 1}
               : LinearColor{1, 1, 1, 1};
  }
  bool says_anything() const override { return true; }

 private:
  const TriangleMesh& mesh_;
};

TEST(Targets, PaintedSurfaceMattersMoreThanBare) {
  const Object sphere = make_sample("sphere");
  Targets targets = spread_targets(sphere, 2000);
  weigh_by_paint(targets, HalfPainted(sphere));
  const double middle = sphere.bounds().center().x();
  for (const Target& t : targets.list) {
    EXPECT_GE(t.importance, 0.2);
    EXPECT_LE(t.importance, 1);
    if (t.position.x() > middle + 5) {
      EXPECT_GT(t.importance, 0.7);
    }
    if (t.position.x() < middle - 5) {
      EXPECT_LT(t.importance, 0.3);
    }
  }
}

TEST(Targets, APictureSaysWhatMatters) {
  const Object sphere = make_sample("sphere");
  Targets targets = spread_targets(sphere, 500);
  weigh_by_picture(targets, HalfPainted(sphere));
  double least = 1, most = 0;
  for (const Target& t : targets.list) {
    least = std::min(least, t.importance);
    most = std::max(most, t.importance);
  }
  EXPECT_NEAR(least, 0.1, 1e-6);
  EXPECT_NEAR(most, 1, 1e-6);
}

class Black : public Paint {
 public:
  Black() : Paint({1, 1, 1, 1}) {}
  LinearColor color_at(const SurfacePoint&) const override { return {0, 0, 0, 1}; }
  bool says_anything() const override { return true; }
};

TEST(Targets, ABlackPictureIsRefused) {
  Targets targets = spread_targets(make_sample("sphere"), 100);
  EXPECT_THROW(weigh_by_picture(targets, Black()), InputError);
}

}  // namespace
}  // namespace hydrodip
