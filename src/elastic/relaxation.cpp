#include "elastic/relaxation.h"

#include <algorithm>

namespace hydrodip {

namespace {

constexpr int kMaxHalvings = 30;

double largest_norm(const VertexVector& x) {
  double largest = 0;
  for (const Vec2& v : x) largest = std::max(largest, v.squaredNorm());
  return std::sqrt(largest);
}

double dot(const VertexVector& a, const VertexVector& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].dot(b[v]);
  return sum;
}

// Moves u by -step * direction unless that turns a triangle over.
bool take_step(const FilmEnergy& energy, const VertexVector& direction, double step,
               VertexVector& u) {
  VertexVector trial(u.size());
  for (std::size_t v = 0; v < u.size(); ++v) trial[v] = u[v] - step * direction[v];
  if (energy.any_inverted(trial)) return false;
  u.swap(trial);
  return true;
}

// Largest of 1, 1/2, 1/4 ... for which u - step * direction turns nothing over and lowers the
// energy enough; 0 if there is none. Moves u.
double line_search(const FilmEnergy& energy, const VertexVector& direction, double slope,
                   VertexVector& u) {
  const double before = energy.value(u);
  // What rounding alone may add: near the minimum, an energy difference cannot be resolved.
  const double noise = 1e-13 * std::abs(before);
  const VertexVector start = u;
  double step = 1;
  for (int halving = 0; halving < kMaxHalvings; ++halving, step *= 0.5) {
    if (!take_step(energy, direction, step, u)) continue;
    if (energy.value(u) <= before - 1e-4 * step * slope + noise) return step;
    u = start;
  }
  return 0;
}

// From the sum of the triangles' definite parts: always downhill.
LinearSolveResult definite_direction(const FilmEnergy& energy,
                                     const std::vector<std::uint8_t>& is_free,
                                     const RelaxationOptions& options, const VertexVector& u,
                                     const VertexVector& gradient, LinearSolver& solver,
                                     BlockMatrix& H, VertexVector& direction) {
  energy.hessian(u, true, H);
  return solver.solve(energy, H, is_free, gradient, options.linear_tolerance, direction);
}

// Newton's direction from the exact Hessian. With the film held at its rim that one is definite as
// long as no triangle shrinks to about half its size (docs/model.md), although single triangles'
// are not; where it fails, the sum of the triangles' definite parts takes its place.
long newton_direction(const FilmEnergy& energy, const std::vector<std::uint8_t>& is_free,
                      const RelaxationOptions& options, const VertexVector& u,
                      const VertexVector& gradient, LinearSolver& solver, BlockMatrix& H,
                      VertexVector& direction) {
  energy.hessian(u, false, H);
  LinearSolveResult solved =
      solver.solve(energy, H, is_free, gradient, options.linear_tolerance, direction);
  long iterations = solved.iterations;
  if (!solved.converged || !(dot(gradient, direction) > 0)) {
    iterations +=
        definite_direction(energy, is_free, options, u, gradient, solver, H, direction).iterations;
  }
  return iterations;
}

}  // namespace

RelaxationResult relax(const FilmEnergy& energy, const std::vector<std::uint8_t>& is_free,
                       const RelaxationOptions& options, LinearSolver& solver, VertexVector& u) {
  RelaxationResult result;
  VertexVector gradient, direction;
  BlockMatrix H;
  while (result.newton_iterations < options.max_iterations) {
    if (options.context) options.context->check_cancelled();
    energy.gradient(u, is_free, gradient);
    result.linear_iterations +=
        newton_direction(energy, is_free, options, u, gradient, solver, H, direction);
    ++result.newton_iterations;
    const double slope = dot(gradient, direction);
    if (!(slope > 0)) {  // nothing to gain: at the minimum, or no descent direction left
      result.converged = slope == 0;
      return result;
    }
    result.last_update_mm = largest_norm(direction);
    result.converged = result.last_update_mm <= options.tolerance_mm;
    // So near the minimum, energy differences drown in rounding: any step that turns nothing over
    // will do.
    if (result.converged && take_step(energy, direction, 1, u)) return result;
    double step = line_search(energy, direction, slope, u);
    if (step == 0) {  // far from the minimum the exact Hessian may mislead
      result.linear_iterations +=
          definite_direction(energy, is_free, options, u, gradient, solver, H, direction)
              .iterations;
      result.last_update_mm = largest_norm(direction);
      step = line_search(energy, direction, dot(gradient, direction), u);
    }
    if (step == 0) return result;
    result.last_update_mm *= step;
  }
  return result;
}

}  // namespace hydrodip
