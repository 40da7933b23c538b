// A regular grid over a box of the plane, to find quickly what lies near.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/math.h"

namespace hydrodip {

// Columns and rows, both ends included.
struct CellRange {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// What lies outside of the box counts to the nearest cells.
struct Cells {
  Vec2 origin = Vec2::Zero();
  double size_mm = 0;
  int nx = 0, ny = 0;

  Cells() = default;
  Cells(const Box2& box, double cell_mm);
  // The cells that the box from min to max touches.
  CellRange around(const Vec2& min, const Vec2& max) const {
    return {cell(min.x() - origin.x(), nx), cell(min.y() - origin.y(), ny),
            cell(max.x() - origin.x(), nx), cell(max.y() - origin.y(), ny)};
  }
  std::size_t number(int x, int y) const {
    return std::size_t(y) * std::size_t(nx) + std::size_t(x);
  }
  std::size_t count() const { return std::size_t(nx) * std::size_t(ny); }

 private:
  int cell(double distance, int cells) const {
    return static_cast<int>(std::clamp(distance / size_mm, 0.0, double(cells - 1)));
  }
};

}  // namespace hydrodip
