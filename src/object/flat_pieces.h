// Connected pieces of a surface that lie in a plane, as the flat sides of CAD models.
#pragma once

#include <cstddef>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// Every triangle is in one of them, most of them alone where the surface is curved: within a piece
// all face the same way to half a degree. Across edges of more than two triangles no piece goes on.
// The largest triangles begin; the order does not depend on the number of threads.
std::vector<std::vector<std::size_t>> flat_pieces(const TriangleMesh& mesh);

}  // namespace hydrodip
