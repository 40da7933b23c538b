#include "object/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace hydrodip {
namespace {

// Three points on the axes beyond the origin tell every rotation apart.
Object marked() {
  Object object;
  object.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  return object;
}

Object posed(const PoseOptions& options) {
  Object object = marked();
  apply_pose(object, pose_matrix(object, options));
  return object;
}

// Where the model's axis i points, in units of its mark's distance.
Vec3 axis(const Object& object, int i) {
  return (object.positions[std::size_t(i + 1)] - object.positions[0]) / (i + 1);
}

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_NEAR((a - b).norm(), 0, 1e-12); }

TEST(Pose, DefaultOnlyCentresAndLifts) {
  const Object object = posed({});
  expect_near(object.positions[0], {-0.5, -1, 0});
  for (int i = 0; i < 3; ++i) expect_near(axis(object, i), Vec3::Unit(i));
}

TEST(Pose, LowestPointAtZeroAndCentredWhateverTheTurn) {
  PoseOptions options;
  for (const ModelSide down : {ModelSide::kPlusX, ModelSide::kMinusX, ModelSide::kPlusY,
                               ModelSide::kMinusY, ModelSide::kPlusZ, ModelSide::kMinusZ}) {
    options.down = down;
    options.rotate_deg = {20, -35, 110};
    const Box3 box = posed(options).bounds();
    EXPECT_NEAR(box.min.z(), 0, 1e-12);
    EXPECT_NEAR(box.center().x(), 0, 1e-12);
    EXPECT_NEAR(box.center().y(), 0, 1e-12);
  }
}

TEST(Pose, DownTurnsThatSideDownByTheSmallestRotation) {
  struct Case {
    ModelSide down;
    int axis;
    double sign;
    int kept;  // the axis that the rotation leaves alone
  };
  for (const Case& c : {Case{ModelSide::kPlusX, 0, 1, 1},
                        {ModelSide::kMinusX, 0, -1, 1},
                        {ModelSide::kPlusY, 1, 1, 0},
                        {ModelSide::kMinusY, 1, -1, 0},
                        {ModelSide::kPlusZ, 2, 1, 0},
                        {ModelSide::kMinusZ, 2, -1, 0}}) {
    PoseOptions options;
    options.down = c.down;
    const Object object = posed(options);
    EXPECT_EQ(Vec3(c.sign * axis(object, c.axis)), Vec3(0, 0, -1)) << side_name(c.down);
    EXPECT_EQ(axis(object, c.kept), Vec3::Unit(c.kept)) << side_name(c.down);
  }
}

TEST(Pose, RotationsAreAboutFixedAxesInOrder) {
  PoseOptions options;
  options.rotate_deg = {90, 90, 0};
  const Object object = posed(options);
  // x: about x stays, about y goes to -z. y: to z, then to x. z: to -y, stays.
  expect_near(axis(object, 0), {0, 0, -1});
  expect_near(axis(object, 1), {1, 0, 0});
  expect_near(axis(object, 2), {0, -1, 0});
  options.rotate_deg = {0, 0, 30};
  expect_near(axis(posed(options), 0), {std::sqrt(0.75), 0.5, 0});
}

TEST(Pose, RotatesAfterDown) {
  PoseOptions options;
  options.down = ModelSide::kMinusY;  // x stays, y goes up
  options.rotate_deg = {0, 0, 90};    // about the bath's vertical
  const Object object = posed(options);
  expect_near(axis(object, 0), {0, 1, 0});
  expect_near(axis(object, 1), {0, 0, 1});
}

TEST(Pose, SizeScalesTheModelsLargestExtent) {
  PoseOptions options;
  options.size_mm = 60;
  options.rotate_deg = {45, 0, 0};  // does not change what is measured
  const Object object = posed(options);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(axis(object, i).norm(), 20, 1e-12);
}

TEST(Pose, RefusesNonsense) {
  const Object object = marked();
  PoseOptions options;
  for (const double size : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    options.size_mm = size;
    EXPECT_THROW(pose_matrix(object, options), InputError);
  }
  options.size_mm = 0;
  options.rotate_deg.y() = std::nan("");
  EXPECT_THROW(pose_matrix(object, options), InputError);
}

}  // namespace
}  // namespace hydrodip
