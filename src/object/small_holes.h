// Holes that the film would bridge.
#pragma once

#include <vector>

#include "object/edges.h"
#include "object/object.h"

namespace hydrodip {

// Closes holes that are small beside the object (0.3 % of it) and beside the shell that they are
// in; a loose scrap's outline is no hole. What closes them looks as their edges do. Returns how
// many. `sides`: sorted_sides(). The object has a material for every triangle. Throws Cancelled.
long close_small_holes(Object& object, const std::vector<TriangleSide>& sides);

}  // namespace hydrodip
