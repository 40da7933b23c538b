// Rectangles on a sheet: where pieces of film are cut from.
#pragma once

#include <vector>

#include "base/math.h"

namespace hydrodip {

struct PackedPiece {
  bool placed = false;
  bool turned = false;   // a quarter turn counter-clockwise
  Vec2 corner_mm{0, 0};  // lower left, from the sheet's lower left
};

// As many of the pieces as can be found room for, none over another, each within the sheet. Sizes
// are width and height in mm. Deterministic; the order of equal pieces is kept.
std::vector<PackedPiece> pack_pieces(const std::vector<Vec2>& sizes_mm, const Vec2& sheet_mm);

}  // namespace hydrodip
