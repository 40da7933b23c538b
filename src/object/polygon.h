// Polygons into triangles.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"

namespace hydrodip {

// Cuts a polygon (corners in order, roughly plane, perhaps concave) into corners.size() - 2
// triangles of indices into `corners`, all turning like the polygon. Ears are clipped in the
// plane of the polygon's mean normal; where none fits (self-intersections), corners are cut off in
// order. Time grows with the number of corners: a polygon that takes more than some thousand looks
// per corner (none that bounds an area does) has the rest cut off in order too. Throws Cancelled
// (run_scope.h).
std::vector<std::array<int, 3>> triangulate(const std::vector<Vec3>& corners);

}  // namespace hydrodip
