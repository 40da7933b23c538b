// Polygons into triangles.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"

namespace hydrodip {

// Cuts a polygon (corners in order, roughly plane, perhaps concave) into corners.size() - 2
// triangles of indices into `corners`, all turning like the polygon. Ears are clipped in the
// plane of the polygon's mean normal; where none fits (self-intersections), corners are cut off in
// order. O(n^2) for convex, O(n^3) for the worst polygons.
std::vector<std::array<int, 3>> triangulate(const std::vector<Vec3>& corners);

}  // namespace hydrodip
