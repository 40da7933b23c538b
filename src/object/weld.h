// Which corners of a mesh are one vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "object/edges.h"
#include "object/object.h"

namespace hydrodip {

// Merges equal positions and drops those that no triangle uses; attributes live at the triangles'
// corners, so nothing else has to follow. New order: first use. Throws Cancelled.
void weld(Object& object);

// The vertices of edges with one face, in order. `sides`: sorted_sides().
std::vector<std::int32_t> rim_vertices(const std::vector<TriangleSide>& sides);

// Joins vertices of rims that rounding alone has parted, as the ends of a turned profile (0 and the
// sine of a whole turn). True if there were any. Throws Cancelled.
bool close_seams(Object& object, const std::vector<TriangleSide>& sides);

}  // namespace hydrodip
