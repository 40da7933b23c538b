// Directions in which the film's energy is minimised, behind one interface.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "elastic/film_energy.h"

namespace hydrodip {

// Where u should go: it becomes u - length * way. `way` is as large as u and zero where there is no
// vertex or one that is held.
struct SearchDirection {
  kernels::Input way;
  double length;
};

// Turns gradients of the energy into directions.
// Solves with the Hessian or something close to it: what is reused from call to call (symbolic
// analysis, unchanged rows) is the solver's own business, as every step is checked against the true
// energy or its gradient.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  // Makes ready for the Hessian of the energy, at its present rest state, at u. `definite`: the sum
  // of the triangles' definite parts (FilmEnergy::hessian). moved_mm: the furthest that a vertex
  // has moved in u since the last call, while nothing else changed; kAnyChange: something else did.
  static constexpr double kAnyChange = 1e300;
  virtual void update(const FilmEnergy& energy, const GridField& u,
                      const std::vector<std::uint8_t>& is_free, bool definite,
                      double moved_mm = kAnyChange) = 0;

  // The next one, from the gradient where the last one has led; valid until the next call. None if
  // the operator turned out not to be definite.
  virtual std::optional<SearchDirection> direction(const GridField& gradient) = 0;
};

// Newton's steps, by sparse Cholesky of H itself, symbolic analysis reused. Slow: the reference.
std::unique_ptr<LinearSolver> make_direct_solver();

// Conjugate directions (Polak and Ribiere's), preconditioned by one cycle of geometric multigrid
// on the film's grid in single precision, as long as the best step along them. Only those rows of
// the Hessian are computed again whose triangles have changed noticeably since they were computed
// last. Keeps a reference to the mesh.
std::unique_ptr<LinearSolver> make_multigrid_solver(const FilmMesh& mesh);

}  // namespace hydrodip
