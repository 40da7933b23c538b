// A square pyramid, tip down, whose edges and tip are rounded by a ball that rolls inside it.
#pragma once

#include <vector>

#include "object/object.h"

namespace hydrodip {

// The sloping side alone, its lowest point at the origin, outside out.
struct RoundedPyramid {
  TriangleMesh side;
  std::vector<std::int32_t> rim;  // level and closed, counterclockwise from above

  // With a flat top on the rim.
  TriangleMesh closed() const;
};

// `width_mm` and `height_mm` are those of the sharp pyramid; the rounded one has its faces and its
// width, and misses its tip. The radius is above 0 and far below what the faces bear.
RoundedPyramid rounded_pyramid(double width_mm, double height_mm, double radius_mm);

}  // namespace hydrodip
