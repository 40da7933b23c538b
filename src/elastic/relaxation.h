// Quasi-static elasticity (paper section 3.2, step 3): the film coordinates that minimise the
// energy, along the directions of a LinearSolver, with line search where it needs one.
#pragma once

#include <vector>

#include "base/context.h"
#include "elastic/film_energy.h"
#include "elastic/linear_solver.h"

namespace hydrodip {

struct RelaxationOptions {
  double tolerance_mm = 1.3e-5;  // stop once no vertex would move further in the next iteration
  // Where the first iteration would move a vertex by w, that tolerance is at least this times w^2,
  // as long as that is no more than loosest_mm.
  double tolerance_per_way2 = 0;  // 1/mm
  double loosest_mm = 0;
  int max_iterations = 200;
  const VertexVector* otherwise = nullptr;  // if given: the start, should u turn a triangle over
  const RunContext* context = nullptr;  // if given: asked between iterations, Cancelled is thrown
};

struct RelaxationResult {
  int iterations = 0;
  double last_update_mm = 0;  // largest move in the last iteration
  bool converged = false;
  // Triangles that would turn over long before the energy falls no further: given up because of
  // them.
  std::vector<std::int32_t> blocked;
};

// Keeps the fields that it computes with, for the next time.
class Relaxation {
 public:
  // Refers to both.
  Relaxation(const FilmEnergy& energy, LinearSolver& solver);

  // Minimises energy.value(u) over the vertices with is_free 1, from the u given. Never turns over
  // a triangle that was not turned over, and never raises the energy.
  RelaxationResult run(const std::vector<std::uint8_t>& is_free, const RelaxationOptions& options,
                       VertexVector& u);
  // The same from and to field().
  RelaxationResult run(const std::vector<std::uint8_t>& is_free, const RelaxationOptions& options);

  // Where the next run without u begins and the last one ended; u = 0 before the first.
  GridField& field() { return u_; }
  const GridField& field() const { return u_; }

 private:
  const FilmEnergy& energy_;
  LinearSolver& solver_;
  GridField u_, gradient_, trial_, trial_gradient_;
  GridArray<double> mask_;

  friend class Descent;
};

}  // namespace hydrodip
