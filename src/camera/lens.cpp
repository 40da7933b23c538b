#include "camera/lens.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "base/eigenpairs.h"

namespace hydrodip {
namespace {

constexpr int kUndistortions = 40;

Vec2 distorted(const Lens& lens, const Vec2& p) {
  const double r2 = p.squaredNorm(), xy = 2 * p.x() * p.y();
  const double radial = 1 + r2 * (lens.k1 + r2 * lens.k2);
  return radial * p + Vec2(lens.p1 * xy + lens.p2 * (r2 + 2 * p.x() * p.x()),
                           lens.p1 * (r2 + 2 * p.y() * p.y()) + lens.p2 * xy);
}

// Moves and scales points to mean 0 and mean distance sqrt(2).
Mat3 normalizing(const std::vector<Vec2>& points) {
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : points) mean += p / double(points.size());
  double distance = 0;
  for (const Vec2& p : points) distance += (p - mean).norm() / double(points.size());
  const double scale = distance > 0 ? std::sqrt(2.0) / distance : 1;
  Mat3 result;
  result << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return result;
}

}  // namespace

Eigen::Matrix<double, Lens::kValues, 1> Lens::values() const {
  Eigen::Matrix<double, kValues, 1> v;
  v << focal_px, center_px, k1, k2, p1, p2;
  return v;
}

Lens Lens::of(const Eigen::Matrix<double, kValues, 1>& v) {
  return {v[0], {v[1], v[2]}, v[3], v[4], v[5], v[6]};
}

Vec2 Lens::project(const Vec3& point) const {
  return center_px + focal_px * distorted(*this, point.head<2>() / point.z());
}

Vec3 Lens::ray(const Vec2& px) const {
  const Vec2 seen = (px - center_px) / focal_px;
  Vec2 p = seen;
  for (int i = 0; i < kUndistortions; ++i) {
    const Vec2 off = distorted(*this, p) - seen;
    p -= off;
    if (off.squaredNorm() < 1e-24) break;
  }
  return {p.x(), p.y(), 1};
}

Mat3 Pose::rotation() const {
  const double angle = turn.norm();
  if (angle < 1e-12) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

Vec3 Pose::operator*(const Vec3& point) const { return rotation() * point + shift; }

Pose Pose::inverse() const { return {-turn, -(rotation().transpose() * shift)}; }

Eigen::Matrix<double, Pose::kValues, 1> Pose::values() const {
  Eigen::Matrix<double, kValues, 1> v;
  v << turn, shift;
  return v;
}

Pose Pose::of(const Eigen::Matrix<double, kValues, 1>& v) { return {v.head<3>(), v.tail<3>()}; }

Pose Pose::of(const Mat3& rotation, const Vec3& shift) {
  const Eigen::AngleAxisd turn(rotation);
  return {turn.angle() * turn.axis(), shift};
}

Pose operator*(const Pose& a, const Pose& b) {
  return Pose::of(a.rotation() * b.rotation(), a * b.shift);
}

Mat3 homography(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
  const Mat3 a = normalizing(from), b = normalizing(to);
  Eigen::MatrixXd rows(2 * Eigen::Index(from.size()), 9);
  rows.setZero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 p = a * from[i].homogeneous();
    const Vec2 q = (b * to[i].homogeneous()).hnormalized();
    const auto row = 2 * Eigen::Index(i);
    rows.row(row).segment<3>(0) = p;
    rows.row(row).segment<3>(6) = -q.x() * p;
    rows.row(row + 1).segment<3>(3) = p;
    rows.row(row + 1).segment<3>(6) = -q.y() * p;
  }
  const Eigen::VectorXd h = eigenpairs(rows.transpose() * rows).vectors.col(0);
  Mat3 result;
  result << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  return b.inverse() * result * a;
}

Pose pose_of_plane(const Mat3& h) {
  Mat3 scaled = h / (0.5 * (h.col(0).norm() + h.col(1).norm()));
  if (scaled(2, 2) < 0) scaled = -scaled;  // before the camera
  Mat3 rotation;
  rotation << scaled.col(0), scaled.col(1), scaled.col(0).cross(scaled.col(1));
  // The nearest rotation: without R^T R's square root.
  const Eigenpairs squared = eigenpairs(rotation.transpose() * rotation);
  const Vec3 shrink = squared.values.cwiseSqrt().cwiseInverse();
  rotation = rotation * (squared.vectors * shrink.asDiagonal() * squared.vectors.transpose());
  return Pose::of(rotation, scaled.col(2));
}

}  // namespace hydrodip
