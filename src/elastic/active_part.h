// The part of a grid on which smoothing pays. From one step of a dip to the next little more
// changes than what lies round the contact line: elsewhere an equation's error is so small, or so
// smooth, that coarser grids take care of it. (Compare the active sets of U. Ruede, Fully adaptive
// multigrid methods, 1993.)
#pragma once

#include <cstddef>
#include <vector>

#include "elastic/grid_operator.h"

namespace hydrodip {

class ActivePart {
 public:
  // At first, all of the operator's grid.
  explicit ActivePart(const GridOperator& A);

  // Chooses anew, for A x = b with x = 0: what one step of Jacobi's would move by more than a small
  // share of its longest move, and some more all around. Grids too small to gain by it stay whole.
  void choose(const GridOperator& A, const GridVector& b);

  // Of a row: what is to be smoothed, ...
  kernels::Part smoothed(std::ptrdiff_t row) const { return part(row, smoothed_); }
  // ... and where that changes the residual.
  kernels::Part reached(std::ptrdiff_t row) const { return part(row, reached_); }
  bool whole(const kernels::Part& part) const {
    return part.group_begin == 0 && part.group_end == groups_;
  }
  // All that is smoothed lies in rows [row_begin, row_end).
  std::ptrdiff_t row_begin() const { return row_begin_; }
  std::ptrdiff_t row_end() const { return row_end_; }

 private:
  // Groups of nodes, the same in all the rows of a band.
  static constexpr std::ptrdiff_t kRowsPerBand = 8;
  struct Span {
    std::ptrdiff_t begin = 0, end = 0;
  };
  static kernels::Part part(std::ptrdiff_t row, const std::vector<Span>& spans) {
    const Span& span = spans[std::size_t(row / kRowsPerBand)];
    return {row, row + 1, span.begin, span.end};
  }
  std::vector<Span> widened(const std::vector<Span>& spans) const;

  std::ptrdiff_t rows_, groups_, bands_;
  std::ptrdiff_t row_begin_, row_end_;
  std::vector<Span> smoothed_, reached_;
  std::vector<float> squares_;  // of moves, by band and group
};

}  // namespace hydrodip
