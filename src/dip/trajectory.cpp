#include "dip/trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace hydrodip {

namespace {

constexpr double kRadPerDeg = M_PI / 180;

bool is_finite(const Keyframe& k) {
  const double sum =
      k.lower_mm + k.shift_x_mm + k.shift_y_mm + k.turn_x_deg + k.turn_y_deg + k.turn_z_deg;
  return std::isfinite(sum);
}

bool only_lowers(const Keyframe& k) {
  return k.shift_x_mm == 0 && k.shift_y_mm == 0 && k.turn_x_deg == 0 && k.turn_y_deg == 0 &&
         k.turn_z_deg == 0;
}

bool goes_straight_down(const std::vector<Keyframe>& keyframes) {
  return keyframes.front().lower_mm <= 0 && std::ranges::all_of(keyframes, only_lowers) &&
         std::ranges::is_sorted(keyframes, {}, &Keyframe::lower_mm);
}

Mat3 turn(const Keyframe& k) {
  const auto about = [](double degrees, const Vec3& axis) {
    return Eigen::AngleAxisd(degrees * kRadPerDeg, axis).toRotationMatrix();
  };
  return about(k.turn_z_deg, Vec3::UnitZ()) * about(k.turn_y_deg, Vec3::UnitY()) *
         about(k.turn_x_deg, Vec3::UnitX());
}

}  // namespace

Trajectory::Trajectory(std::vector<Keyframe> keyframes, const Vec3& pivot_mm)
    : keyframes_(std::move(keyframes)),
      pivot_(pivot_mm),
      straight_(goes_straight_down(keyframes_)) {}

Trajectory Trajectory::straight_down(double depth_mm) {
  return through({{}, {.lower_mm = depth_mm}});
}

Trajectory Trajectory::through(std::vector<Keyframe> keyframes, const Vec3& pivot_mm) {
  if (keyframes.size() < 2)
    throw InputError("a path needs two keyframes at least: where it begins and where it ends");
  if (!std::ranges::all_of(keyframes, is_finite) || !pivot_mm.allFinite())
    throw InputError("a path's keyframes and its pivot must be finite numbers");
  return {std::move(keyframes), pivot_mm};
}

Keyframe Trajectory::at(double t) const {
  const std::size_t pieces = keyframes_.size() - 1;
  const double along = std::clamp(t, 0.0, 1.0) * double(pieces);
  const std::size_t piece = std::min(std::size_t(along), pieces - 1);
  const double s = along - double(piece);
  const Keyframe &a = keyframes_[piece], &b = keyframes_[piece + 1];
  const auto between = [&](double Keyframe::*value) { return std::lerp(a.*value, b.*value, s); };
  return {between(&Keyframe::lower_mm),   between(&Keyframe::shift_x_mm),
          between(&Keyframe::shift_y_mm), between(&Keyframe::turn_x_deg),
          between(&Keyframe::turn_y_deg), between(&Keyframe::turn_z_deg)};
}

Eigen::Isometry3d Trajectory::bath_from_object(double t) const {
  const Keyframe k = at(t);
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = turn(k);
  transform.translation() =
      pivot_ - transform.linear() * pivot_ + Vec3(k.shift_x_mm, k.shift_y_mm, -k.lower_mm);
  return transform;
}

Trajectory make_trajectory(const TrajectoryOptions& options, const std::vector<Vec3>& positions) {
  if (!(options.depth_mm >= 0)) throw InputError("dip.depth_mm must not be negative");
  double top = 0;
  for (const Vec3& p : positions) top = std::max(top, p.z());
  return Trajectory::straight_down(options.depth_mm > 0 ? std::min(options.depth_mm, top) : top);
}

}  // namespace hydrodip
