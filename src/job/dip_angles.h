// How steeply the object's surface meets the water, without simulating.
#pragma once

#include <array>

#include "object/object.h"

namespace hydrodip {

// The paper's limit between dipping direction and surface normal; beyond it the film tears.
constexpr double kDipAngleLimit_deg = 45;

struct DipAngles {
  static constexpr int kBins = 9;  // of 10 degrees

  // Surface area below the dipping depth by the angle between the dipping direction (down) and the
  // outward normal; [0]: 0 to 10 degrees.
  std::array<double, kBins> area_mm2{};
  double downward_mm2 = 0;    // sum of the bins: angle below 90 degrees
  double upward_mm2 = 0;      // the rest, which the film reaches only by wrapping around
  double over_limit_mm2 = 0;  // downward, beyond kDipAngleLimit_deg

  double over_limit_share() const { return downward_mm2 > 0 ? over_limit_mm2 / downward_mm2 : 0; }
};

// Angle between the dipping direction (0, 0, -1) and a unit normal.
double dip_angle_deg(const Vec3& normal);

// `posed` in the posed-object frame. Faces count by the position of their centre.
DipAngles dip_angles(const Object& posed, double depth_mm);

}  // namespace hydrodip
