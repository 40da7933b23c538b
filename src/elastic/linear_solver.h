// Solvers for one Newton step of the film, behind one interface.
#pragma once

#include <cstdint>
#include <memory>

#include "elastic/film_energy.h"

namespace hydrodip {

struct LinearSolveResult {
  int iterations = 0;      // 0 for a direct solve
  bool converged = false;  // false: the operator is not definite, or too many iterations
};

// Solves H x = b over the vertices whose is_free is 1; x is zero elsewhere. H is the Hessian or
// close to it: what is reused from call to call (symbolic analysis, unchanged rows) is the solver's
// own business, as Newton's method checks every step against the true gradient.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  // Makes ready for the Hessian of the energy, at its present rest state, at u. `definite`: the sum
  // of the triangles' definite parts (FilmEnergy::hessian). moved_mm: the furthest that a vertex
  // has moved in u since the last call, while nothing else changed; kAnyChange: something else did.
  static constexpr double kAnyChange = 1e300;
  virtual void update(const FilmEnergy& energy, const VertexVector& u,
                      const std::vector<std::uint8_t>& is_free, bool definite,
                      double moved_mm = kAnyChange) = 0;
  virtual LinearSolveResult solve(const VertexVector& b, double relative_tolerance,
                                  VertexVector& x) = 0;
  // How often everything was computed anew.
  virtual long factorizations() const = 0;
};

// Sparse Cholesky of H itself, symbolic analysis reused. Exact, slow: the reference.
std::unique_ptr<LinearSolver> make_direct_solver();

// Conjugate gradients, preconditioned by geometric multigrid on the film's grid, in single
// precision. Only those rows of the Hessian are computed again whose triangles have changed
// noticeably since they were computed last. Keeps a reference to the mesh.
std::unique_ptr<LinearSolver> make_multigrid_solver(const FilmMesh& mesh);

}  // namespace hydrodip
