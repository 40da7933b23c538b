// Geometric multigrid for the film's Hessian: block stencils on the film's own grid, coarsened by
// two in both directions, coarse operators by Galerkin's products with bilinear interpolation.
// Single precision: it preconditions a solver that checks itself.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <vector>

#include "elastic/active_part.h"
#include "elastic/grid_operator.h"

namespace hydrodip {

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

  // x = M^-1 b, one V-cycle: for what is smoothed, which depends on b (active_part.h), symmetric,
  // and positive definite if the smoothers damp all of the operator's eigenvalues. Estimates say
  // which those are ...
  void cycle(const GridVector& b, GridVector& x);
  // ... and this widens them, where they turn out too low. False if they cannot be.
  bool widen();

 private:
  struct Level {
    explicit Level(int nx, int ny);
    GridOperator A;
    GridVector b, x, other;
    std::vector<std::uint8_t> touched;
    std::vector<std::int32_t> to_do;      // touched nodes
    double largest = 0;                   // eigenvalue of D^-1 A to be damped
    std::vector<float> weights = {1, 1};  // of the smoothing steps
    ActivePart active;                    // where they are made
  };
  void touch(Level& level, int i, int j);
  void coarsen(const Level& fine, Level& coarse) const;
  GridOperator::Row galerkin_row(const GridOperator& fine, int I, int J) const;
  void choose_weights(Level& level) const;
  void factor_coarsest();
  void solve_coarsest(const GridVector& b, GridVector& x) const;
  void go_down(Level& level, const GridVector& b, GridVector& x, Level& coarse) const;
  void come_up(const Level& coarse, Level& level, const GridVector& b, GridVector& x) const;
  void cycle(std::size_t level, const GridVector& b, GridVector& x);

  std::vector<Level> levels_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  std::vector<std::size_t> coarsest_place_;  // of its unknowns, in vectors
};

}  // namespace hydrodip
