// A turn and a shift in a plane.
#pragma once

#include <vector>

#include "base/math.h"

namespace hydrodip {

struct PlanarMotion {
  double x = 0, y = 0, turn = 0;  // turned by that (rad) about the origin, then shifted

  Vec2 operator*(const Vec2& point) const;
};

// What takes points to where they are seen, by least squares.
PlanarMotion planar_fit(const std::vector<Vec2>& from, const std::vector<Vec2>& to);

// Value by value, which one that is far off does not move. At least one.
PlanarMotion median_of(const std::vector<PlanarMotion>& all);

}  // namespace hydrodip
