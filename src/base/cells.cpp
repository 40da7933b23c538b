#include "base/cells.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {

Cells::Cells(const Box2& box, double cell_mm) : origin(box.min), size_mm(cell_mm) {
  const Vec2 size = box.max - box.min;
  nx = static_cast<int>(size.x() / size_mm) + 1;
  ny = static_cast<int>(size.y() / size_mm) + 1;
}

CellRange Cells::around(const Vec2& min, const Vec2& max) const {
  const auto cell = [&](double distance, int cells) {
    return static_cast<int>(std::clamp(std::floor(distance / size_mm), 0.0, double(cells - 1)));
  };
  return {cell(min.x() - origin.x(), nx), cell(min.y() - origin.y(), ny),
          cell(max.x() - origin.x(), nx), cell(max.y() - origin.y(), ny)};
}

}  // namespace hydrodip
