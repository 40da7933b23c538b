// A camera: where it stands, and what its lens does.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/math.h"

namespace hydrodip {

// A pinhole with the distortion of Brown, "Close-range camera calibration" (1971): two radial and
// two tangential terms. Pixels are square; their centres lie at +0.5, y down.
struct Lens {
  static constexpr int kValues = 7;
  double focal_px = 1000;
  Vec2 center_px = Vec2::Zero();
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;

  Eigen::Matrix<double, kValues, 1> values() const;
  static Lens of(const Eigen::Matrix<double, kValues, 1>& values);

  // A point in the camera's frame (x right, y down, z ahead; z above 0).
  Vec2 project(const Vec3& point) const;
  // The direction from which a pixel sees: a point with z = 1.
  Vec3 ray(const Vec2& px) const;
};

// A rigid motion as six values: an axis times its angle (rad), and a shift.
struct Pose {
  static constexpr int kValues = 6;
  Vec3 turn = Vec3::Zero(), shift = Vec3::Zero();

  Vec3 operator*(const Vec3& point) const;
  Mat3 rotation() const;
  Pose inverse() const;
  Eigen::Matrix<double, kValues, 1> values() const;
  static Pose of(const Eigen::Matrix<double, kValues, 1>& values);
  static Pose of(const Mat3& rotation, const Vec3& shift);
};
Pose operator*(const Pose& a, const Pose& b);

// Pairs of points in two planes to the homography between them; at least four, no three of which
// lie on a line. (Normalised direct linear transform, Hartley and Zisserman, "Multiple view
// geometry", 4.4.)
Mat3 homography(const std::vector<Vec2>& from, const std::vector<Vec2>& to);

// Where a plane (z = 0) stands before a camera that sees it with z = 1 by this homography.
Pose pose_of_plane(const Mat3& homography);

}  // namespace hydrodip
