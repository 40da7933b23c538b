// Two meshes as one.
#pragma once

#include "object/object.h"

namespace hydrodip {

// `more` comes after what is there.
inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto base = std::int32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (const Triangle& t : more.triangles)
    mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
}

}  // namespace hydrodip
