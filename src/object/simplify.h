// A coarser object in an object's place, for a quick look.
#pragma once

#include <cstddef>

#include "object/object.h"

namespace hydrodip {

// Vertices that share a cell of a grid, with so many cells along the object's longest side, become
// one, in their middle; triangles keep their own texture coordinates, colours and materials, and
// those without an area are left out. Throws Cancelled.
Object drawn_together(const Object& object, double cells_across);

// The object with at most about so many triangles, or a copy of it if it has no more: vertices that
// lie close together become one, as above. Its box is the object's. Throws Cancelled.
Object simplified(const Object& object, std::size_t most_triangles);

}  // namespace hydrodip
