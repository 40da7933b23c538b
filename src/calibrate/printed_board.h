// The board as it is printed for a calibration.
#pragma once

#include "film/film.h"
#include "ink/inks.h"
#include "scan/board.h"
#include "transfer/raster.h"

namespace hydrodip {

// Printed inside the taped margin.
struct PrintedBoard {
  InkImage inks;
  SheetRaster raster;
};
PrintedBoard print_board(const FilmOptions& film, const Board& board);

}  // namespace hydrodip
