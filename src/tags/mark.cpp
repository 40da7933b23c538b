#include "tags/mark.h"

#include "tags/apriltag.h"

namespace hydrodip {
namespace {

constexpr double kHalf = 0.5 * kMarkCells;

// A rectangle in cells, from the tag's upper left, y down, as it lies on the plane.
Box2 placed(const MarkPlace& mark, double x0, double y0, double x1, double y1) {
  const Vec2 up(-mark.along.y(), mark.along.x());
  Box2 box;
  for (const Vec2& cells : {Vec2(x0, y0), Vec2(x1, y1)})
    box.add(mark.corner + mark.cell_mm * ((cells.x() - kMarkCells - kHalf) * mark.along +
                                          (kHalf - cells.y()) * up));
  return box;
}

// Runs of black cells along the rows, or along the columns.
void add_runs(const TagCells& cells, bool rows, const MarkPlace& mark, std::vector<Box2>& boxes) {
  const auto black = [&](int line, int at) {
    return rows ? cells[std::size_t(line)][std::size_t(at)]
                : cells[std::size_t(at)][std::size_t(line)];
  };
  for (int line = 0; line < kMarkCells; ++line)
    for (int begin = 0; begin < kMarkCells; ++begin) {
      if (!black(line, begin) || (begin > 0 && black(line, begin - 1))) continue;
      int end = begin + 1;
      while (end < kMarkCells && black(line, end)) ++end;
      // A single cell is in the runs across as well.
      if (!rows && end - begin == 1) continue;
      boxes.push_back(rows ? placed(mark, begin, line, end, line + 1)
                           : placed(mark, line, begin, line + 1, end));
    }
}

}  // namespace

std::vector<Box2> mark_boxes(const MarkPlace& mark) {
  const TagCells cells = tag_cells(mark.id);
  std::vector<Box2> boxes;
  add_runs(cells, true, mark, boxes);
  add_runs(cells, false, mark, boxes);
  constexpr double kMiddle = kMarkCells + kHalf;
  boxes.push_back(placed(mark, kMarkCells, 0, kMiddle, kHalf));
  boxes.push_back(placed(mark, kMiddle, kHalf, 2 * kMarkCells, kMarkCells));
  return boxes;
}

Box2 mark_outline(const MarkPlace& mark) { return placed(mark, 0, 0, 2 * kMarkCells, kMarkCells); }

}  // namespace hydrodip
