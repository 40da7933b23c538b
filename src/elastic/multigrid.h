// Geometric multigrid for the film's Hessian: block stencils on the film's own grid, coarsened by
// two in both directions, coarse operators by Galerkin's products with bilinear interpolation.
// Single precision: it preconditions a solver that checks itself.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "elastic/film_grid.h"
#include "elastic/kernels.h"

namespace hydrodip {

// The operator of one level. A node that is not free has an empty row and keeps the value zero.
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

  void multiply(const GridVector& x, GridVector& out) const;
  void residual(const GridVector& b, const GridVector& x, GridVector& r) const;
  void smooth(const GridVector& b, const GridVector& x, float weight, GridVector& out) const;
  void precondition(const GridVector& b, float weight, GridVector& out) const;
  // Largest eigenvalue of D^-1 A, by power iteration: from below, within a few per cent.
  double largest_eigenvalue() const;

 private:
  // Arrays over the grid (kernels::Stencil), one after the other.
  static constexpr int kOwn = 0, kInverse = 3, kForward = 6,
                       kEntries = kForward + 4 * kernels::kForward;
  const float* entry(int e) const { return entries_.data() + std::size_t(e) * layout_.entries(); }
  float* entry(int e) { return entries_.data() + std::size_t(e) * layout_.entries(); }
  kernels::Stencil stencil() const;

  GridLayout layout_;
  const kernels::Table& kernels_;
  GridArray<float> mask_, entries_;
};

// A hierarchy of operators that is kept up to date where the finest one changes.
class Multigrid {
 public:
  Multigrid(int nx, int ny);

  GridOperator& finest() { return levels_.front().A; }
  const GridOperator& finest() const { return levels_.front().A; }

  // To be called for nodes of the finest grid whose row has changed ...
  void touch(int i, int j);
  // (so far: j * nx + i of each)
  const std::vector<std::int32_t>& touched() const { return levels_.front().to_do; }
  // ... and then once. `all`: everything has changed.
  void update(bool all);

  // x = M^-1 b, one V-cycle: symmetric, and positive definite if the smoothers damp all of the
  // operator's eigenvalues. Estimates say which those are ...
  void cycle(const GridVector& b, GridVector& x);
  // ... and this widens them, where they turn out too low. False if they cannot be.
  bool widen();

 private:
  struct Level {
    explicit Level(int nx, int ny);
    GridOperator A;
    GridVector b, x, other;
    std::vector<std::uint8_t> touched;
    std::vector<std::int32_t> to_do;  // touched nodes
    double largest = 0;               // eigenvalue of D^-1 A to be damped
    float weight[2] = {1, 1};         // of the two smoothing steps
  };
  void touch(Level& level, int i, int j);
  void coarsen(const Level& fine, Level& coarse) const;
  GridOperator::Row galerkin_row(const GridOperator& fine, int I, int J) const;
  static void choose_weights(Level& level);
  void factor_coarsest();
  void restrict_to(const Level& fine, const GridVector& r, Level& coarse) const;
  void prolong_and_add(const Level& coarse, const Level& fine, GridVector& x) const;
  void solve_coarsest(const GridVector& b, GridVector& x) const;
  void cycle(std::size_t level, const GridVector& b, GridVector& x);

  std::vector<Level> levels_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  std::vector<std::size_t> coarsest_place_;  // of its unknowns, in vectors
};

}  // namespace hydrodip
