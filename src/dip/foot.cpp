#include "dip/foot.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hydrodip {

namespace {

// Cosines of turns of the waterline: from a bend on, up to a corner.
constexpr double kBend = 0.9, kCorner = 0.5;

// Share of its way from which on a foot has nearly arrived; what its ghost's gradient lags behind
// by then, at most, as a share of the way; how much more late changes count than early ones.
constexpr double kNearlyArrived = 0.8, kLag = 0.1, kLateChanges = 2;

// Length from (0, 0) to (run, rise) with the vertical scaled: along two straight pieces with the
// given slopes if they meet on the way (a crease lies between), else along the chord.
double scaled_length(double run, double rise, double first_slope, double last_slope,
                     double z_stretch) {
  const auto piece = [&](double x, double z) { return std::hypot(x, z_stretch * z); };
  if (first_slope != last_slope) {
    const double x = (rise - last_slope * run) / (first_slope - last_slope);
    const double z = first_slope * x;
    if (std::isfinite(x) && z >= 0 && z <= rise) {
      const double bent = piece(x, z) + piece(run - x, rise - z);
      // Never longer than over the two sides of the box: slopes of a ragged mesh mean little.
      if (bent <= std::abs(run) + z_stretch * rise) return bent;
    }
  }
  return piece(run, rise);
}

}  // namespace

void GhostGradient::follow(const Mat2& expected, double last_mm, double way_mm, double share) {
  const double arrived = std::max(0.0, (share - kNearlyArrived) / (1 - kNearlyArrived));
  const double lag_mm = kLag * way_mm * arrived;
  if (!(last_mm > 0)) {
    if (!(lag_mm > 0)) now = expected;
    return;
  }
  const Mat2 before = now;
  const Mat2 straight_on = now + last_mm * change_per_mm;
  now = straight_on + last_mm / (last_mm + lag_mm) * (expected - straight_on);
  const double weight = std::min(1.0, kLateChanges * last_mm / way_mm);
  change_per_mm += weight * ((now - before) / last_mm - change_per_mm);
}

bool usable_gradient(const Mat2& F) {
  return F.allFinite() && F.determinant() > 1e-3 && F.squaredNorm() < 1e4;
}

Vec2 unrolled(const Vec3& from, const Vec2& first_outward, double first_slope,
              const Waterline::Point& to, double to_z, double z_stretch) {
  const Vec2 way = to.position - from.head<2>();
  // Across the line in the middle of the way; around a corner, more and more as at its end.
  const double turn = first_outward.dot(to.outward);
  Vec2 across =
      (to.outward + std::clamp((turn - kCorner) / (kBend - kCorner), 0.0, 1.0) * first_outward)
          .normalized();
  // A way along the line must not seem to lead back.
  if (way.dot(across) < 0 && way.dot(to.outward) > 0) across = to.outward;
  const Vec2 tangent(-across.y(), across.x());
  const double run = way.dot(across), rise = to_z - from.z();
  // A point that touched just above the water, beyond the line, has its way back to it.
  const double length = run < 0 && rise < 0 ? -std::hypot(run, z_stretch * rise)
                                            : scaled_length(run, std::max(0.0, rise), first_slope,
                                                            to.steepness, z_stretch);
  return way.dot(tangent) * tangent + length * across;
}

double steepness_along(const Vec3& normal, const Vec2& direction) {
  const double n = normal.head<2>().dot(direction);
  return std::abs(normal.z()) * kWall > std::abs(n) ? -n / normal.z() : kWall;
}

void place_ghost(Foot& foot) {
  const Mat2& F = foot.ghost_gradient.now;
  Vec2 back = foot.way;
  if (usable_gradient(F)) {
    const Vec2 strained = F.inverse() * foot.laid;
    const Vec2 change = strained - foot.way;
    const double limit = 0.5 * foot.way.norm();
    back += change.norm() > limit ? Vec2(change * (limit / change.norm())) : change;
  }
  foot.ghost = foot.place - back;
}

}  // namespace hydrodip
