// Where the water cuts an object, as lines seen from above: what a person aims with.
#pragma once

#include <array>
#include <vector>

#include "dip/trajectory.h"

namespace hydrodip {

using OutlineSegment = std::array<Vec2, 2>;  // mm in the bath plane; of no length at times

struct DipOutlines {
  std::vector<OutlineSegment> first_touch;  // once the object has come in by a millimetre
  // At the end of the way. If the object is below the water then: where it was widest.
  std::vector<OutlineSegment> full_depth;
};

// Throws InputError if the object is in the water at the start, or never gets wet; Cancelled.
DipOutlines dip_outlines(const Trajectory& trajectory, const std::vector<Vec3>& positions,
                         const std::vector<Triangle>& triangles);

}  // namespace hydrodip
