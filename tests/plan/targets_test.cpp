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

TEST(Targets, InAPoseLieOnTheSurfaceAsItHangs) {
  const auto sphere = std::make_shared<const Object>(make_sample("sphere"));
  PoseOptions pose;
  pose.size_mm = 25;
  pose.rotate_deg = {30, 40, 50};
  const PosedObject posed(sphere, pose);
  for (const Target& target : spread_targets(*sphere, 50).list) {
    const Target hung = in_pose(target, posed);
    EXPECT_LT((hung.position - position_at(posed.mesh(), target.point)).norm(), 1e-9);
    EXPECT_LT((hung.normal - face_normal(posed.mesh(), target.point.triangle)).norm(), 1e-9);
  }
}

class HalfPainted : public Paint {
 public:
  // `off`: from the middle, in shares of half the size; nearer to 1, less is painted.
  explicit HalfPainted(const TriangleMesh& mesh, double off = 0)
      : Paint({1, 1, 1, 1}),
        mesh_(mesh),
        from_(mesh.bounds().center().x() + 0.5 * off * mesh.bounds().size().x()) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    return position_at(mesh_, point).x() > from_ ? LinearColor{0.1F, 0.1F, 0.1F, 1}
                                                 : LinearColor{1, 1, 1, 1};
  }
  bool says_anything() const override { return true; }

 private:
  const TriangleMesh& mesh_;
  double from_;
};

TEST(Targets, PaintedSurfaceMattersMoreThanBare) {
  const Object sphere = make_sample("sphere");
  Targets targets = spread_targets(sphere, 2000);
  weigh_by_paint(targets, HalfPainted(sphere));
  const double middle = sphere.bounds().center().x();
  for (const Target& t : targets.list) {
    EXPECT_GE(t.importance, 0.15);
    EXPECT_LE(t.importance, 1);
    if (t.position.x() > middle + 5) {
      EXPECT_GT(t.importance, 0.7);
    }
    if (t.position.x() < middle - 5) {
      EXPECT_LT(t.importance, 0.3);
    }
  }
}

TEST(Targets, ASmallPictureMattersMoreThanAllThatIsBare) {
  const Object sphere = make_sample("sphere");
  for (const double off : {0.5, 0.9, 0.99}) {  // a quarter of the sphere, 5 and 0.5 %
    Targets targets = spread_targets(sphere, 20000);
    const HalfPainted paint(sphere, off);
    weigh_by_paint(targets, paint);
    // Its edge counts with it, as detail.
    const double half = 0.5 * sphere.bounds().size().x();
    const double edge = sphere.bounds().center().x() + off * half - 0.15 * half;
    double painted = 0, bare = 0;
    for (const Target& t : targets.list)
      (t.position.x() > edge ? painted : bare) += t.area * t.importance;
    EXPECT_GT(painted, 2.5 * bare) << off;
    EXPECT_GT(bare, 0) << off;  // of two ways that show the picture alike, the one that covers more
    EXPECT_NEAR(painted + bare, targets.weight, 1e-9 * targets.weight);
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
