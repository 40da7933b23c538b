// The corners of a board's dark squares, found on a scan by its colours.
#pragma once

#include <array>
#include <vector>

#include "object/object.h"
#include "scan/corner_grid.h"

namespace hydrodip {

// One dark square on the scan: its corners, counter-clockwise seen from outside.
struct DarkSquare {
  std::array<Vec3, 4> corner;
  Vec3 normal = Vec3::UnitZ();  // of the surface around it, outwards
  Vec3 middle() const { return 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]); }
};

// Squares that are dark on pale ground and touch no other, about square_mm wide, wherever the
// scan's colours (texture or vertices) show them whole. A square's edges are bent lines through
// where brightness passes half way; its corners are where these meet. Throws Cancelled.
std::vector<DarkSquare> find_dark_squares(const Object& scan, double square_mm);

// Rows and columns from which square lies beside which, one other square between them: a dark
// square's corners have the places {2 i, 2 j} to {2 i + 1, 2 j + 1}. Squares whose neighbours
// contradict each other are left out.
CornerGrid grid_of_dark_squares(const std::vector<DarkSquare>& squares);

}  // namespace hydrodip
