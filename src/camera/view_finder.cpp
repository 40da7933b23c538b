#include "camera/view_finder.h"

#include <algorithm>
#include <cmath>

#include "base/eigenpairs.h"
#include "camera/corner_fit.h"

namespace hydrodip {
namespace {

// From picture to picture a phone focuses anew, and its lens floats.
constexpr double kRefocus = 0.003, kFloat_px = 5;

}  // namespace

bool reaches_around(const RimCorners& corners) {
  if (corners.size() < kLeastBoardMarks) return false;
  Mat2 spread = Mat2::Zero();
  Vec2 mean = Vec2::Zero();
  const auto count = double(corners.size());
  for (const RimCorner& c : corners) mean += c.at.head<2>() / count;
  for (const RimCorner& c : corners)
    spread += (c.at.head<2>() - mean) * (c.at.head<2>() - mean).transpose() / count;
  return eigenpairs(spread).values[0] > 400;
}

Vec2 on_level(const ViewValues& values, const Vec2& px, double z_mm) {
  const Pose pose = Pose::of(values.head<6>());
  const Lens lens = Lens::of(values.segment<Lens::kValues>(6));
  const Mat3 back = pose.rotation().transpose();
  const Vec3 eye = -(back * pose.shift), ray = back * lens.ray(px);
  return (eye + (z_mm - eye.z()) / ray.z() * ray).head<2>();
}

ViewFinder::ViewFinder(const Tank& tank, double water_sigma_mm)
    : tank_(tank), water_sigma_mm_(water_sigma_mm) {
  Eigen::Matrix<double, Lens::kValues, Lens::kValues> known = tank.lens_covariance;
  known(0, 0) += std::pow(kRefocus * tank.lens.focal_px, 2);
  known(1, 1) += kFloat_px * kFloat_px;
  known(2, 2) += kFloat_px * kFloat_px;
  // In units of its deviation, along axes in which it is independent.
  const Eigenpairs axes = eigenpairs(known);
  to_units_ = axes.values.cwiseMax(1e-300).cwiseSqrt().cwiseInverse().asDiagonal() *
              axes.vectors.transpose();
}

Eigen::VectorXd ViewFinder::start(const RimCorners& corners) const {
  std::vector<Vec2> flat, seen;
  for (const RimCorner& c : corners) {
    flat.emplace_back(c.at.head<2>());
    seen.emplace_back(tank_.lens.ray(c.px).head<2>());
  }
  Eigen::VectorXd values(View::kValues);
  values << pose_of_plane(homography(flat, seen)).values(), tank_.lens.values(),
      tank_.water_below_mm;
  return values;
}

Fit ViewFinder::fit(const RimCorners& corners, const Eigen::VectorXd& from) const {
  return least_squares([&](const Eigen::VectorXd& v) { return residuals(v, corners); }, from);
}

Eigen::MatrixXd ViewFinder::covariance(const Fit& fit) {
  return std::max(1.0, scatter_of(fit)) * fit.covariance;
}

Eigen::VectorXd ViewFinder::residuals(const Eigen::VectorXd& v, const RimCorners& corners) const {
  const Pose pose = Pose::of(v.head<6>());
  const Mat3 turn = pose.rotation();
  const Lens lens = Lens::of(v.segment<Lens::kValues>(6));
  const auto end = 2 * Eigen::Index(corners.size());
  Eigen::VectorXd off(end + Lens::kValues + 1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Vec3 point = turn * corners[i].at + pose.shift;
    point.z() = std::max(point.z(), 1.0);
    off.segment<2>(2 * Eigen::Index(i)) = (lens.project(point) - corners[i].px) / kCorner_px;
  }
  off.segment(end, Lens::kValues) = to_units_ * (v.segment(6, Lens::kValues) - tank_.lens.values());
  off[end + Lens::kValues] = (v[View::kValues - 1] - tank_.water_below_mm) / water_sigma_mm_;
  return off;
}

}  // namespace hydrodip
