#include "dip/outlines.h"

#include <algorithm>

#include "base/run_scope.h"
#include "dip/travel.h"

namespace hydrodip {

namespace {

constexpr double kTouch_mm = 1;
constexpr int kMomentsOfWidest = 32;

// Triangles have a point in the water or not: what a corner of height 0 belongs to is above it.
std::vector<OutlineSegment> water_outline(const Moment& moment, const std::vector<Vec3>& positions,
                                          const std::vector<Triangle>& triangles) {
  std::vector<OutlineSegment> outline;
  CheckEvery check(1 << 12);
  for (const Triangle& triangle : triangles) {
    check();
    std::array<Vec2, 3> cuts;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = positions[std::size_t(triangle[k])];
      const Vec3& b = positions[std::size_t(triangle[(k + 1) % 3])];
      const double above = moment.height(a), below = moment.height(b);
      if ((above < 0) == (below < 0)) continue;
      const double share = above / (above - below);
      cuts[count++] = moment.to_sinking(a + share * (b - a)).head<2>();
    }
    if (count == 2) outline.push_back({cuts[0], cuts[1]});
  }
  return outline;
}

double width_of(const std::vector<OutlineSegment>& outline) {
  Box2 box;
  for (const OutlineSegment& segment : outline)
    for (const Vec2& end : segment) box.add(end);
  return outline.empty() ? 0 : (box.max - box.min).norm();
}

}  // namespace

DipOutlines dip_outlines(const Trajectory& trajectory, const std::vector<Vec3>& positions,
                         const std::vector<Triangle>& triangles) {
  const Travel travel(trajectory, positions, triangles);
  const double length = travel.length_mm();
  const auto at = [&](double travelled_mm) {
    return water_outline(travel.at(travelled_mm), positions, triangles);
  };
  DipOutlines outlines{at(std::min(kTouch_mm, 0.5 * length)), at(length)};
  if (outlines.full_depth.empty())
    for (int n = 1; n < kMomentsOfWidest; ++n) {
      std::vector<OutlineSegment> outline = at(length * n / kMomentsOfWidest);
      if (width_of(outline) > width_of(outlines.full_depth))
        outlines.full_depth = std::move(outline);
    }
  return outlines;
}

}  // namespace hydrodip
