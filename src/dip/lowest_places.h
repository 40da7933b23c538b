// Where the water comes to an object before it comes to anything around.
#pragma once

#include <vector>

#include "base/math.h"

namespace hydrodip {

// Heights of all points that are lower than everything around them, in the frame of the positions;
// ascending. Corners at one place count as one, whether triangles share them or not.
std::vector<double> lowest_places(const std::vector<Vec3>& positions,
                                  const std::vector<Triangle>& triangles);

}  // namespace hydrodip
