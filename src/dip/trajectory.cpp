#include "dip/trajectory.h"

#include <fmt/format.h>

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

// Rz Ry Rx.
Keyframe turned_by(const Mat3& turn) {
  Keyframe k;
  k.turn_y_deg = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0)) / kRadPerDeg;
  k.turn_x_deg = std::atan2(turn(2, 1), turn(2, 2)) / kRadPerDeg;
  k.turn_z_deg = std::atan2(turn(1, 0), turn(0, 0)) / kRadPerDeg;
  return k;
}

// Between two keyframes angles are linear, which is a little off the way about a slanted axis.
constexpr double kDegreesPerKeyframe = 1;
// Further over, angles about x and z are nearly the same thing.
constexpr double kMostLean_deg = 85;

// Its lowest point goes down evenly.
Trajectory leaning(const TrajectoryOptions& options, const std::vector<Vec3>& positions) {
  const double tilt = options.tilt_deg, all = options.tilt_deg + options.roll_deg;
  if (!(std::abs(tilt) <= kMostLean_deg && std::abs(all) <= kMostLean_deg))
    throw InputError(fmt::format(
        "dip.tilt_deg, and dip.tilt_deg and dip.roll_deg together, must be within {} degrees: turn "
        "the object as it begins with --rotate",
        kMostLean_deg));
  const double toward = options.tilt_toward_deg * kRadPerDeg;
  const Vec3 axis(-std::sin(toward), std::cos(toward), 0);
  const int pieces =
      std::max(1, int(std::ceil(std::abs(options.roll_deg) / kDegreesPerKeyframe - 1e-9)));
  std::vector<Keyframe> keyframes;
  Box2 plan;
  double depth = options.depth_mm;
  for (int n = pieces; n >= 0; --n) {
    const double down = double(n) / pieces;
    const double lean = (options.tilt_deg + down * options.roll_deg) * kRadPerDeg;
    const Mat3 turn = Eigen::AngleAxisd(lean, axis).toRotationMatrix();
    double low = 1e300, high = -1e300;
    for (const Vec3& p : positions) {
      const Vec3 x = turn * p;
      plan.add(x.head<2>());
      low = std::min(low, x.z());
      high = std::max(high, x.z());
    }
    // The last one comes first.
    if (n == pieces) depth = depth > 0 ? std::min(depth, high - low) : high - low;
    Keyframe k = turned_by(turn);
    k.lower_mm = low + down * depth;
    keyframes.push_back(k);
  }
  std::ranges::reverse(keyframes);
  const Vec2 middle = 0.5 * (plan.min + plan.max);
  for (Keyframe& k : keyframes) {
    k.shift_x_mm = -middle.x();
    k.shift_y_mm = -middle.y();
  }
  return Trajectory::through(std::move(keyframes));
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
  if (!options.path.empty()) {
    if (options.depth_mm > 0 || options.tilt_deg != 0 || options.roll_deg != 0)
      throw InputError(
          "a path says all of the way in: leave out dip.depth_mm, dip.tilt_deg and dip.roll_deg");
    return Trajectory::through(options.path, options.pivot_mm);
  }
  if (options.tilt_deg != 0 || options.roll_deg != 0) return leaning(options, positions);
  double top = 0;
  for (const Vec3& p : positions) top = std::max(top, p.z());
  return Trajectory::straight_down(options.depth_mm > 0 ? std::min(options.depth_mm, top) : top);
}

}  // namespace hydrodip
