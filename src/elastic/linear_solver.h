// Solvers for one Newton step of the film, behind one interface.
#pragma once

#include <cstdint>
#include <memory>

#include "elastic/film_energy.h"

namespace hydrodip {

struct LinearSolveResult {
  int iterations = 0;  // 0 for a direct solve
  bool converged = false;
};

// Solves H x = b over the vertices whose is_free is 1; x is zero elsewhere. What is reused from
// call to call (symbolic analysis, an older factorisation) is the solver's own business and never
// changes the result by more than the tolerance.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  // energy: at its present rest state; H: its definite Hessian.
  virtual LinearSolveResult solve(const FilmEnergy& energy, const BlockMatrix& H,
                                  const std::vector<std::uint8_t>& is_free, const VertexVector& b,
                                  double relative_tolerance, VertexVector& x) = 0;

  virtual long factorizations() const = 0;
};

// Sparse Cholesky of H itself, symbolic analysis reused. Exact, slow: the reference.
std::unique_ptr<LinearSolver> make_direct_solver();

// Conjugate gradients preconditioned with a sparse Cholesky factorisation of the scalar film
// Laplacian of an earlier step, applied to both coordinates. With the film held at its rim the two
// operators are within a factor of two of each other (Korn's inequality, Poisson ratio 0), so a
// handful of iterations is enough on any mesh; the factor is renewed when they grow.
std::unique_ptr<LinearSolver> make_laplacian_solver();

}  // namespace hydrodip
