// Pictures of errors: over the searched parameters, and over the film.
#pragma once

#include <string>
#include <vector>

#include "calibrate/search.h"
#include "image/image.h"

namespace hydrodip {

// Eq. 4 of all scans over each pair of parameters, the third as good as it gets; the grid's best
// and the answer marked.
Image draw_error_surface(const GridSearchOptions& options, const std::vector<GridPointError>& grid,
                         const FilmParameters& answer, const std::string& caption);

// Where each pair of parameters can be together, the third as good as it gets: joint regions of 50
// and 95 % by noise alone, with the answer, and the single intervals, which hold what simulations
// add, beside them. Needs two free parameters; pairs of
// others are left out.
Image draw_joint_regions(const Answer& answer, const std::string& caption);

// A warped grid: the film, with each length in the colour of its error.
struct ErrorMap {
  std::string title;   // above it
  std::string figure;  // below it
  WarpedGrid warped;
  std::vector<LengthError> errors;
};
// Rows of maps, with one scale for all.
Image draw_error_maps(const std::vector<std::vector<ErrorMap>>& rows, const std::string& caption);

}  // namespace hydrodip
