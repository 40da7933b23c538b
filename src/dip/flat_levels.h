// Where the waterline jumps because the object is flat there.
#pragma once

#include <vector>

#include "base/math.h"

namespace hydrodip {

// Heights at which so much of the object is level that the water meets or leaves it all at once, in
// the frame of the positions; ascending.
std::vector<double> flat_levels(const std::vector<Vec3>& positions,
                                const std::vector<Triangle>& triangles, double least_area_mm2);

}  // namespace hydrodip
