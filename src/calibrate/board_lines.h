// The grid of a calibration's film, laid on the board's squares: ink changes hundredfold at their
// edges, and a triangle that lies across one has the mean of both, which is far too stiff.
#pragma once

#include "film/film.h"
#include "scan/board.h"

namespace hydrodip {

// How finely.
struct BoardGrid {
  int cells = 2;       // along a square
  int ramp_cells = 1;  // across what the stiffness filter carries over an edge
  int halvings = 0;    // of every cell
};

// Lines on every edge of a square, and beside it, in the square with less ink, where the filter's
// reach ends: every triangle lies in evenly inked film, or in what is smeared over one edge.
// Coarser where the kit's shapes take up no film. `filter_mm`: StiffnessOptions::filter_mm.
GridLines board_lines(const FilmOptions& film, const Board& board, double filter_mm,
                      const BoardGrid& grid);

// The one with a number of triangles near to the film's `elements`.
BoardGrid board_grid(const FilmOptions& film, const Board& board, double filter_mm);

}  // namespace hydrodip
