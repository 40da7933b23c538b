#include "transfer/film_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydrodip {
namespace {

constexpr int kLongestSide = 400;  // cells: about half a millimetre on A4

}  // namespace

FilmCells empty_cells(const Box2& extent) {
  FilmCells cells;
  if (extent.empty()) return cells;
  cells.extent = extent;
  const Vec2 size = extent.max - extent.min;
  const double cell = std::max(1e-6, size.maxCoeff() / kLongestSide);
  cells.width = std::max(1, int(std::ceil(size.x() / cell - 1e-9)));
  cells.height = std::max(1, int(std::ceil(size.y() / cell - 1e-9)));
  cells.values.assign(std::size_t(cells.width) * std::size_t(cells.height),
                      std::numeric_limits<float>::quiet_NaN());
  return cells;
}

CellMeans::CellMeans(const SheetRaster& raster, const Box2& extent)
    : empty_(empty_cells(extent)),
      column_of_(std::size_t(raster.width_px()), -1),
      row_of_(std::size_t(raster.height_px()), -1),
      sum_(empty_.values.size(), 0),
      count_(empty_.values.size(), 0) {
  if (empty_.values.empty()) return;
  const Vec2 size = extent.max - extent.min;
  const int width_px = raster.width_px(), height_px = raster.height_px();
  for (int x = 0; x < width_px; ++x) {
    const double u = (x + 0.5) / width_px * raster.width_mm - 0.5 * raster.width_mm;
    const double column = (u - extent.min.x()) / size.x() * empty_.width;
    if (column >= 0 && column < empty_.width) column_of_[std::size_t(x)] = int(column);
  }
  for (int y = 0; y < height_px; ++y) {
    const double u = 0.5 * raster.height_mm - (y + 0.5) / height_px * raster.height_mm;
    const double row = (extent.max.y() - u) / size.y() * empty_.height;
    if (row >= 0 && row < empty_.height) row_of_[std::size_t(y)] = int(row);
  }
}

void CellMeans::add(int x, int y, float value) {
  const int column = column_of_[std::size_t(x)], row = row_of_[std::size_t(y)];
  if (column < 0 || row < 0) return;
  const std::size_t cell = std::size_t(row) * std::size_t(empty_.width) + std::size_t(column);
  sum_[cell] += double(value);
  ++count_[cell];
}

FilmCells CellMeans::cells() const {
  FilmCells cells = empty_;
  for (std::size_t i = 0; i < cells.values.size(); ++i)
    if (count_[i] > 0) cells.values[i] = float(sum_[i] / count_[i]);
  return cells;
}

}  // namespace hydrodip
