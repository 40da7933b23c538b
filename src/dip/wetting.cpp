#include "dip/wetting.h"

#include <optional>
#include <utility>
#include <vector>

#include "dip/travel.h"

namespace hydrodip {

namespace {

// A path is looked at so often.
constexpr int kMoments = 128;

}  // namespace

DippingDirection dipping_direction(const Trajectory& trajectory, const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles) {
  if (trajectory.is_straight_down()) return straight_down_to(trajectory.depth_mm());
  const Travel travel(trajectory, positions, triangles);
  std::vector<Moment> moments;
  for (int n = 0; n <= kMoments; ++n)
    moments.push_back(travel.at(travel.length_mm() * n / kMoments));
  return [moments = std::move(moments)](const Vec3& point, double slack_mm) -> std::optional<Vec3> {
    for (const Moment& moment : moments)
      if (moment.sinking_z(point) <= moment.level_mm + slack_mm)
        return Vec3(-moment.turn.row(2).transpose());
    return std::nullopt;
  };
}

}  // namespace hydrodip
