// Which way faces look.
#pragma once

#include <cstddef>
#include <vector>

#include "object/edges.h"
#include "object/object.h"

namespace hydrodip {

struct Orientation {
  long flipped = 0;          // faces that were turned
  long one_sided_edges = 0;  // where no choice agrees
};

// Makes faces agree across edges that exactly two share, and turns each closed shell outward (one
// nested in another keeps the sense that makes it a cavity); open ones keep the majority of the
// file. `sides`: sorted_sides(). Throws Cancelled.
Orientation orient_faces(Object& object, const std::vector<TriangleSide>& sides);

// Six times the signed volume between the triangle and `origin`.
double volume6(const Object& object, std::size_t face, const Vec3& origin);

}  // namespace hydrodip
