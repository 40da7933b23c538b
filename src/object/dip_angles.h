// How steeply the object's surface meets the water, without simulating.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "object/object.h"

namespace hydrodip {

// The paper's limit between dipping direction and surface normal; beyond it the film tears.
constexpr double kDipAngleLimit_deg = 45;
// Angles this near to a limit count as at it: a cone of 45 degrees, cut into flat facets, is hardly
// steeper than 45 degrees, and a vertical wall stays vertical whatever rounding makes of it.
constexpr double kDipAngleTolerance_deg = 0.1;

struct DipAngles {
  static constexpr int kBins = 9;  // of 10 degrees

  // Surface area below the dipping depth by the angle between the dipping direction (down) and the
  // outward normal; [0]: 0 to 10 degrees.
  std::array<double, kBins> area_mm2{};
  double downward_mm2 = 0;    // sum of the bins
  double upward_mm2 = 0;      // the rest, vertical included: the film comes only by wrapping around
  double over_limit_mm2 = 0;  // downward, beyond kDipAngleLimit_deg

  double over_limit_share() const { return downward_mm2 > 0 ? over_limit_mm2 / downward_mm2 : 0; }
};

// Angle between the dipping direction and a unit normal.
double dip_angle_deg(const Vec3& normal, const Vec3& direction = Vec3(0, 0, -1));

// The dipping direction (unit, posed-object frame) at the moment at which the water first reaches a
// point of the object; empty if it stays more than slack_mm above the water.
using DippingDirection = std::function<std::optional<Vec3>(const Vec3& point, double slack_mm)>;
DippingDirection straight_down_to(double depth_mm);

// Whether film coming from below meets such a surface face on, if at a slant; vertical does not.
constexpr bool faces_down(double angle_deg) { return angle_deg < 90 - kDipAngleTolerance_deg; }
constexpr bool beyond_dip_limit(double angle_deg) {
  return angle_deg > kDipAngleLimit_deg + kDipAngleTolerance_deg;
}

// `posed` in the posed-object frame. Faces count by the position of their centre.
DipAngles dip_angles(const TriangleMesh& posed, double depth_mm);  // straight down
DipAngles dip_angles(const TriangleMesh& posed, const DippingDirection& direction_at);

}  // namespace hydrodip
