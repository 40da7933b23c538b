// A symmetric operator on the film's grid, and on the coarser ones of multigrid: every node is
// coupled with its eight neighbours by 2 x 2 blocks. Single precision.
#pragma once

#include <array>
#include <cstddef>

#include "elastic/film_grid.h"
#include "elastic/kernels.h"

namespace hydrodip {

// A node that is not free has an empty row and keeps the value zero.
class GridOperator {
 public:
  GridOperator(int nx, int ny);

  const GridLayout& layout() const { return layout_; }
  int nx() const { return layout_.nx; }
  int ny() const { return layout_.ny; }
  std::size_t nodes() const { return std::size_t(nx()) * std::size_t(ny()); }
  std::size_t node(int i, int j) const {
    return std::size_t(j) * std::size_t(nx()) + std::size_t(i);
  }
  std::size_t place(int i, int j) const { return layout_.place(i, j); }
  bool is_free(int i, int j) const { return mask()[place(i, j)] > 0; }
  // 1 on free nodes, 0 elsewhere, laid out like vectors.
  const float* mask() const { return mask_.data(); }

  GridVector vector() const { return GridVector(layout_); }

  using Row = std::array<std::array<float, 4>, 9>;  // [3 * (dj + 1) + di + 1][xx, xy, yx, yy]
  // Only blocks of nodes that follow are kept: the operator is symmetric. An empty row (or a
  // diagonal block that is not positive definite) makes the node unfree.
  void set_row(int i, int j, const Row& row);
  Row row(int i, int j) const;

  // Calls body(begin, end) over the grid's rows, in parallel where that pays.
  template <typename Body>
  void for_rows(const Body& body) const {
    layout_.for_rows(ny(), body);
  }

  // As the kernels take it, and whole rows [begin, end) of it.
  kernels::Stencil stencil() const;
  kernels::Part rows(std::ptrdiff_t begin, std::ptrdiff_t end) const {
    return {begin, end, 0, layout_.groups};
  }

  // out = A x, out = weight * D^-1 b.
  void multiply(const GridVector& x, GridVector& out) const;
  void precondition(const GridVector& b, float weight, GridVector& out) const;
  // Largest eigenvalue of D^-1 A, by power iteration: from below, within a few per cent.
  double largest_eigenvalue() const;

 private:
  // Arrays over the grid (kernels::Stencil), one after the other.
  static constexpr int kOwn = 0, kInverse = 3, kForward = 6,
                       kEntries = kForward + 4 * kernels::kForward;
  const float* entry(int e) const { return entries_.data() + std::size_t(e) * layout_.entries(); }
  float* entry(int e) { return entries_.data() + std::size_t(e) * layout_.entries(); }

  GridLayout layout_;
  const kernels::Table& kernels_;
  GridArray<float> mask_, entries_;
};

}  // namespace hydrodip
