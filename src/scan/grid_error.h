// Eq. 4: how far the warped grid is from the regular one that was printed.
#pragma once

#include <optional>
#include <vector>

#include "scan/corner_grid.h"
#include "transfer/film_map.h"

namespace hydrodip {

// Film coordinates (mm) from which a film map says the corners came; nothing where it has no film
// at the corner. Corners lie near the surface, within reach_mm of it.
using WarpedGrid = std::vector<std::optional<Vec2>>;
WarpedGrid warp(const CornerGrid& grid, const Surface& surface, const FilmMap& map,
                double reach_mm);

// One compared length.
struct LengthError {
  GridLength length;
  double error_mm = 0;  // on the film: the warped length minus the printed one
};

// Those of `lengths` whose ends the film map knows.
std::vector<LengthError> length_errors(const std::vector<GridLength>& lengths,
                                       const WarpedGrid& warped, double square_mm);

// Eq. 4 with |e| and |d| read as counts: a root mean square in mm. The printed formula divides a
// sum of squares by a sum of lengths, of which the root is mm^0.5; literal is its value.
struct GridError {
  double rms_mm = 0;
  double literal = 0;  // mm^0.5
  double edge_rms_mm = 0, diagonal_rms_mm = 0;
  double mean_mm = 0;   // of the absolute errors
  double worst_mm = 0;  // largest absolute error
  int edges = 0, diagonals = 0;
};
GridError grid_error(const std::vector<LengthError>& errors, double square_mm);

}  // namespace hydrodip
