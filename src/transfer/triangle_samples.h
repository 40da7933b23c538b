// The samples under one triangle of film.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"
#include "transfer/film_map.h"

namespace hydrodip {

// Points of the film in even rows and columns, rows towards -y.
struct SampleGrid {
  Vec2 first;  // film coordinates of the one in the upper left corner, mm
  double step_mm = 0;
  int columns = 0, rows = 0;

  Vec2 at(double column, double row) const {
    return {first.x() + column * step_mm, first.y() - row * step_mm};
  }
  // What `at` undoes.
  Vec2 column_and_row(const Vec2& film_mm) const {
    return {(film_mm.x() - first.x()) / step_mm, (first.y() - film_mm.y()) / step_mm};
  }
};

// A function that is linear over the film, by a sample's column and row.
struct LinearOnGrid {
  double first = 0, across = 0, down = 0;
  double at(double column, double row) const { return first + column * across + row * down; }
};

// Rows, or columns of a row, from `begin` to before `end`.
struct Span {
  int begin = 0, end = 0;
  bool empty() const { return begin >= end; }
};

// Samples where a linear function is not below zero.
class HalfPlane {
 public:
  explicit HalfPlane(const LinearOnGrid& function)
      : function_(function), per_across_(function.across != 0 ? 1 / function.across : 0) {}

  // Of columns of a row.
  Span in_row(int row, Span columns) const;
  // Of rows, those in which some of the columns may have one.
  Span rows(Span rows, const Span& columns) const;

 private:
  LinearOnGrid function_;
  double per_across_;
};

// The samples of a grid that a triangle of film holds where it is whole; those on its sides, too.
class TriangleSamples {
 public:
  TriangleSamples(const LyingTriangle& film, const SampleGrid& grid);

  bool empty() const { return columns_.empty(); }
  // Limits of its samples.
  const Span& rows() const { return rows_; }
  const Span& columns() const { return columns_; }
  // Its samples in one of those rows.
  const Span& in_row(int row) const { return spans_[std::size_t(row - rows_.begin)]; }
  // The function that has these values at the triangle's corners.
  LinearOnGrid linear(const std::array<double, 3>& at_corners) const;

 private:
  void find_spans(const std::array<Vec2, 3>& corner, const std::array<double, 3>& excess,
                  const SampleGrid& grid);

  std::array<LinearOnGrid, 3> weight_;  // of the corners
  Span rows_, columns_;
  std::vector<Span> spans_;  // of those rows
};

}  // namespace hydrodip
