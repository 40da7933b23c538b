// A quantity over a part of the film, in cells of about half a millimetre.
#pragma once

#include <vector>

#include "base/math.h"
#include "transfer/raster.h"

namespace hydrodip {

struct FilmCells {
  Box2 extent;                // film coordinates, mm
  int width = 0, height = 0;  // cells
  std::vector<float> values;  // row 0 at +y; NaN where there is nothing
};

// Nothing in them yet; no cells if the extent is empty.
FilmCells empty_cells(const Box2& extent);

// Means of what pixels of the film image have, over cells.
class CellMeans {
 public:
  // Of cells within the film coordinates `extent`.
  CellMeans(const SheetRaster& raster, const Box2& extent);

  // Pixels row by row, so that the sums do not depend on who adds them.
  void add(int x, int y, float value);
  // NaN where nothing was added.
  FilmCells cells() const;

 private:
  FilmCells empty_;
  std::vector<int> column_of_, row_of_;  // of the image's columns and rows; -1: outside
  std::vector<double> sum_;              // per cell
  std::vector<int> count_;
};

}  // namespace hydrodip
