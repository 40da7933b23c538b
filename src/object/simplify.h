// A coarser object in an object's place, for a quick look.
#pragma once

#include <cstddef>

#include "object/object.h"

namespace hydrodip {

// The object with at most about so many triangles, or a copy of it if it has no more: vertices that
// lie close together become one, and triangles keep their own texture coordinates, colours and
// materials. Its box is the object's.
Object simplified(const Object& object, std::size_t most_triangles);

}  // namespace hydrodip
