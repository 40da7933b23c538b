// Faces that say nothing of the surface, and go.
#pragma once

#include <cstddef>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// All return how many went.

// Of fewer than three vertices.
long drop_collapsed(Object& object);

// Of corners on one line: such a sliver still joins its neighbours, so it goes last.
long drop_slivers(Object& object);

// A face that lay on another one, its back to that one's front, and went.
struct BackToBack {
  std::size_t kept;  // the other
  Triangle kept_corners, corners;
  int material = 0;
  CornerUv uvs;
  CornerColor colors;
};

// Of the same three positions, in any order, as an earlier face. `backs`: of those that went, in
// the numbers of the faces that stay. Throws Cancelled.
long drop_duplicates(Object& object, std::vector<BackToBack>& backs);

// Of two faces, each the other's back, the one that turned out to look outward is seen.
void show_outer(Object& object, const std::vector<BackToBack>& pairs);

}  // namespace hydrodip
