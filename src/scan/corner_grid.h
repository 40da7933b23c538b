// The corners of the checkerboard's squares, found again on a dipped and scanned object.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace hydrodip {

// A corner's column and row. Columns count along the film's +x, rows along its +y, both from an
// origin that only the corners of one patch share; quarter turns are open as well. The handedness
// is not: seen from outside the object, a quad's corners run counter-clockwise, which on the film,
// seen from above, is clockwise.
using GridPlace = std::array<int, 2>;

struct CornerGrid {
  std::vector<Vec3> position;    // mm
  std::vector<GridPlace> place;  // per corner
  std::vector<int> patch;        // per corner: places of different patches are not related
};

// A length that Eq. 4 compares: between two corners that were neighbours on the film.
struct GridLength {
  std::int32_t from = 0, to = 0;
  bool diagonal = false;
};

// Every edge and diagonal between neighbouring corners of one patch, in a fixed order.
std::vector<GridLength> grid_lengths(const CornerGrid& grid);

// Rows and columns from a quad mesh's connectivity. Quads that are turned the other way than most
// are turned round. Corners of no quad are left out. Throws InputError (naming `name`) if an edge
// belongs to more than two quads, the quads' rows and columns contradict each other, or a quad has
// a corner twice.
CornerGrid grid_of_quads(const std::vector<Vec3>& corners,
                         const std::vector<std::array<std::int32_t, 4>>& quads,
                         const std::string& name);

}  // namespace hydrodip
