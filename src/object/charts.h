// Pieces of a surface that a picture can be laid under without folding it.
#pragma once

#include <cstddef>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// Every triangle is in one of them, and each lies in the plane of its first triangle once it is
// drawn into it along that plane's normal: all face the same way to 40 degrees, and none comes to
// lie over another by more than a thousandth of the object's size. Across edges of more than two
// triangles no chart goes on. The largest triangles begin; the order does not depend on the number
// of threads. Throws Cancelled.
std::vector<std::vector<std::size_t>> charts(const TriangleMesh& mesh);

}  // namespace hydrodip
