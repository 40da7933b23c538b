#include "transfer/triangle_samples.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

constexpr double kInside = -1e-9;

// Of numbers that are not negative, without a call.
int rounded_down(double value) { return int(value); }
int rounded_up(double value) {
  const int down = int(value);
  return down + (down < value ? 1 : 0);
}

}  // namespace

Span HalfPlane::in_row(int row, Span columns) const {
  const double start = function_.first + row * function_.down;
  if (function_.across == 0) return start >= 0 ? columns : Span{};
  const double zero = -start * per_across_;
  if (function_.across > 0) {
    if (zero > columns.begin) columns.begin = zero < columns.end ? rounded_up(zero) : columns.end;
  } else if (zero < columns.end - 1) {
    columns.end = zero >= columns.begin ? rounded_down(zero) + 1 : columns.begin;
  }
  return columns;
}

Span HalfPlane::rows(Span rows, const Span& columns) const {
  const double best = function_.across > 0 ? columns.end - 1 : columns.begin;
  const LinearOnGrid along_rows{function_.at(best, 0), function_.down, 0};
  return HalfPlane(along_rows).in_row(0, rows);
}

TriangleSamples::TriangleSamples(const LyingTriangle& film, const SampleGrid& grid) {
  std::array<Vec2, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = grid.column_and_row(film.film_mm[k]);
  const Vec2 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const double twice = cross2(ab, ac);
  if (twice == 0) return;
  weight_[1] = {-cross2(corner[0], ac) / twice, ac.y() / twice, -ac.x() / twice};
  weight_[2] = {-cross2(ab, corner[0]) / twice, -ab.y() / twice, ab.x() / twice};
  weight_[0] = {1 - weight_[1].first - weight_[2].first, -weight_[1].across - weight_[2].across,
                -weight_[1].down - weight_[2].down};
  find_spans(corner, film.excess, grid);
}

LinearOnGrid TriangleSamples::linear(const std::array<double, 3>& at_corners) const {
  const double b = at_corners[1] - at_corners[0], c = at_corners[2] - at_corners[0];
  return {at_corners[0] + b * weight_[1].first + c * weight_[2].first,
          b * weight_[1].across + c * weight_[2].across, b * weight_[1].down + c * weight_[2].down};
}

void TriangleSamples::find_spans(const std::array<Vec2, 3>& corner,
                                 const std::array<double, 3>& excess, const SampleGrid& grid) {
  const double top = std::min({corner[0].y(), corner[1].y(), corner[2].y()});
  const double bottom = std::max({corner[0].y(), corner[1].y(), corner[2].y()});
  rows_ = {int(std::floor(std::clamp(top, 0.0, double(grid.rows)))),
           int(std::ceil(std::clamp(bottom, -1.0, double(grid.rows) - 1))) + 1};
  std::vector<HalfPlane> sides;
  for (LinearOnGrid weight : weight_) {
    weight.first -= kInside;
    sides.emplace_back(weight);
  }
  if (std::max({excess[0], excess[1], excess[2]}) > 0)
    sides.emplace_back(linear({-excess[0], -excess[1], -excess[2]}));
  columns_ = {grid.columns, 0};
  for (int row = rows_.begin; row < rows_.end; ++row) {
    Span span{0, grid.columns};
    for (const HalfPlane& side : sides) span = side.in_row(row, span);
    spans_.push_back(span);
    if (!span.empty())
      columns_ = {std::min(columns_.begin, span.begin), std::max(columns_.end, span.end)};
  }
}

}  // namespace hydrodip
