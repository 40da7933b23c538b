// When and how a point of the object meets the water on its way.
#pragma once

#include <vector>

#include "dip/trajectory.h"
#include "object/dip_angles.h"

namespace hydrodip {

// Of an object with these vertices and triangles. To be asked from many threads. Throws InputError
// as Travel does.
DippingDirection dipping_direction(const Trajectory& trajectory, const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles);

}  // namespace hydrodip
