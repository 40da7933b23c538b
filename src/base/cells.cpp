#include "base/cells.h"

namespace hydrodip {

Cells::Cells(const Box2& box, double cell_mm) : origin(box.min), size_mm(cell_mm) {
  const Vec2 size = box.max - box.min;
  nx = static_cast<int>(size.x() / size_mm) + 1;
  ny = static_cast<int>(size.y() / size_mm) + 1;
}

}  // namespace hydrodip
