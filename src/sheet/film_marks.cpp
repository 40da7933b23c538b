#include "sheet/film_marks.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

constexpr double kLeastMarginMm = 6, kLeastSideMm = 120;
constexpr double kMostOffEdgeMm = 3.5, kOffEdge = 1.0 / 3;
constexpr double kMostTapeMm = 3;
// Tags of one sheet, and how many sets of them there are.
constexpr int kMost = 10, kKinds = kFirstBoardTag / kMost;
constexpr double kLargestCellMm = 1.2;
// Three marks of 20 cells and their gaps along half an edge and a bit.
constexpr double kLeastRoomMm = 30, kCellsShare = 0.017;
// What the bottom's marks leave free in the middle: the ruler with its numbers.
constexpr double kRulerRoomMm = 112;

double off_edge_mm(double margin_mm) { return std::min(kMostOffEdgeMm, kOffEdge * margin_mm); }

}  // namespace

std::vector<MarkPlace> film_marks(double width_mm, double height_mm, double margin_mm) {
  if (margin_mm < kLeastMarginMm || std::min(width_mm, height_mm) < kLeastSideMm) return {};
  const double off_edge = off_edge_mm(margin_mm);
  const double room = 0.5 * std::min(width_mm, height_mm) - margin_mm;
  if (room < kLeastRoomMm) return {};
  const double cell =
      std::min({kLargestCellMm, (margin_mm - off_edge) / (kMarkCells + 1), room * kCellsShare});
  const double half_length = kMarkCells * cell;
  const Vec2 half(0.5 * width_mm, 0.5 * height_mm);
  // The marks' middle lines, and how far along them the outermost ones stand.
  const Vec2 line = half - Vec2::Constant(off_edge + 0.5 * kMarkCells * cell);
  const Vec2 end = half - Vec2::Constant(margin_mm + half_length);
  const auto kind = int(std::lround(7 * width_mm + 13 * height_mm + 29 * margin_mm) % kKinds);
  std::vector<MarkPlace> marks;
  // `middle`: of tag and squares together.
  const auto add = [&](int id, const Vec2& middle, const Vec2& along) {
    marks.push_back({kMost * kind + id, middle + 0.5 * half_length * along, along, cell});
  };
  // Around clockwise, seen from above; read from inside the sheet, the tag is on the left.
  add(0, {-end.x(), line.y()}, Vec2::UnitX());
  add(1, {end.x(), line.y()}, Vec2::UnitX());
  add(2, {line.x(), end.y()}, -Vec2::UnitY());
  add(3, {line.x(), 0.55 * end.y()}, -Vec2::UnitY());
  add(4, {line.x(), -end.y()}, -Vec2::UnitY());
  if (width_mm - 2 * (margin_mm + 2 * half_length) >= kRulerRoomMm) {
    add(5, {end.x(), -line.y()}, -Vec2::UnitX());
    add(6, {-end.x(), -line.y()}, -Vec2::UnitX());
  }
  add(7, {-line.x(), -end.y()}, Vec2::UnitY());
  add(8, {-line.x(), 0.55 * end.y()}, Vec2::UnitY());
  add(9, {-line.x(), end.y()}, Vec2::UnitY());
  return marks;
}

double tape_mm(double width_mm, double height_mm, double margin_mm, bool with_marks) {
  if (!with_marks || film_marks(width_mm, height_mm, margin_mm).empty()) return margin_mm;
  return std::min(kMostTapeMm, off_edge_mm(margin_mm));
}

}  // namespace hydrodip
