#include "elastic/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace hydrodip {

namespace {

constexpr int kMaxHalvings = 30;
// Share of the slope that may be left at the end of a whole step.
constexpr double kFlattened = 0.5;
// What is left of an error after one iteration, until the second shows.
constexpr double kFirstContraction = 0.2;

// Sum or maximum over chunks of vertices, in their order.
template <typename Body>
std::vector<double> over_chunks(std::size_t count, const Body& body) {
  std::vector<double> partial((count + kElementGrain - 1) / kElementGrain, 0.0);
  parallel_for(count, kElementGrain, [&](std::size_t begin, std::size_t end) {
    partial[begin / kElementGrain] = body(begin, end);
  });
  return partial;
}

double largest_norm(const VertexVector& x) {
  const auto partial = over_chunks(x.size(), [&](std::size_t begin, std::size_t end) {
    double largest = 0;
    for (std::size_t v = begin; v < end; ++v) largest = std::max(largest, x[v].squaredNorm());
    return largest;
  });
  return std::sqrt(*std::max_element(partial.begin(), partial.end()));
}

double dot(const VertexVector& a, const VertexVector& b) {
  const auto partial = over_chunks(a.size(), [&](std::size_t begin, std::size_t end) {
    // Several sums at once: one alone would wait for itself.
    Vec2 sum[4] = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
    std::size_t v = begin;
    for (; v + 4 <= end; v += 4)
      for (std::size_t k = 0; k < 4; ++k) sum[k] += a[v + k].cwiseProduct(b[v + k]);
    for (; v < end; ++v) sum[0] += a[v].cwiseProduct(b[v]);
    return Vec2((sum[0] + sum[1]) + (sum[2] + sum[3])).sum();
  });
  return std::accumulate(partial.begin(), partial.end(), 0.0);
}

// The descent and what it carries from one iteration to the next.
class Descent {
 public:
  Descent(const FilmEnergy& energy, const std::vector<std::uint8_t>& is_free,
          const RelaxationOptions& options, LinearSolver& solver, VertexVector& u)
      : energy_(energy), is_free_(is_free), options_(options), solver_(solver), u_(u) {}

  RelaxationResult run() {
    const bool turned_over = energy_.gradient(u_, is_free_, gradient_) > 0;
    if (turned_over && options_.otherwise) {
      u_ = *options_.otherwise;
      energy_.gradient(u_, is_free_, gradient_);
    }
    double contraction = kFirstContraction;
    while (result_.iterations < options_.max_iterations) {
      if (options_.context) options_.context->check_cancelled();
      if (!find_direction()) return result_;
      ++result_.iterations;
      if (slope_ == 0) {  // at the minimum
        result_.converged = true;
        return result_;
      }
      const double update = largest_norm(direction_);
      if (result_.iterations > 1) contraction = std::min(1.0, update / result_.last_update_mm);
      result_.last_update_mm = update;
      // What the next iterations would still change.
      result_.converged = update * contraction <= options_.tolerance_mm;
      if (result_.converged && take_last_step()) return result_;
      if (!take_whole_step() && !search()) return result_;
    }
    return result_;
  }

 private:
  // With the exact Hessian. With the film held at its rim that one is definite as long as no
  // triangle shrinks to about half its size (docs/model.md), although single triangles' are not;
  // where it fails, the sum of the triangles' definite parts takes its place from there on.
  bool find_direction() {
    solver_.update(energy_, u_, is_free_, definite_, moved_mm_);
    moved_mm_ = 0;
    return goes_down() || (!definite_ && find_definite_direction());
  }

  bool find_definite_direction() {
    definite_ = true;
    solver_.update(energy_, u_, is_free_, true);
    return goes_down();
  }

  bool goes_down() {
    if (!solver_.direction(gradient_, direction_)) return false;
    slope_ = dot(gradient_, direction_);
    return slope_ >= 0;
  }

  void move_to(double step) {
    trial_.resize(u_.size());
    parallel_for(u_.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) trial_[v] = u_[v] - step * direction_[v];
    });
  }

  // So near the minimum, any step that turns nothing over will do.
  bool take_last_step() {
    move_to(1);
    if (energy_.any_inverted(trial_)) return false;
    u_.swap(trial_);
    return true;
  }

  // The energy is convex enough along the way if its slope has become small at the end: then the
  // step is taken without asking for the energy itself.
  bool take_whole_step() {
    move_to(1);
    if (energy_.gradient(trial_, is_free_, trial_gradient_) > 0) return false;
    if (std::abs(dot(trial_gradient_, direction_)) > kFlattened * slope_) return false;
    u_.swap(trial_);
    gradient_.swap(trial_gradient_);
    moved_mm_ += result_.last_update_mm;
    return true;
  }

  // Halves the step until the energy falls; far from the minimum, where the exact Hessian may
  // mislead, once more along the definite direction.
  bool search() {
    if (line_search()) return true;
    return !definite_ && find_definite_direction() && line_search();
  }

  bool line_search() {
    const double before = energy_.value(u_);
    // What rounding alone may add: near the minimum, an energy difference cannot be resolved.
    const double noise = 1e-13 * std::abs(before);
    double step = 1;
    for (int halving = 0; halving < kMaxHalvings; ++halving, step *= 0.5) {
      move_to(step);
      if (energy_.any_inverted(trial_)) continue;
      if (energy_.value(trial_) > before - 1e-4 * step * slope_ + noise) continue;
      u_.swap(trial_);
      energy_.gradient(u_, is_free_, gradient_);
      result_.last_update_mm = step * largest_norm(direction_);
      moved_mm_ += result_.last_update_mm;
      return true;
    }
    return false;
  }

  const FilmEnergy& energy_;
  const std::vector<std::uint8_t>& is_free_;
  const RelaxationOptions& options_;
  LinearSolver& solver_;
  VertexVector& u_;
  VertexVector gradient_, direction_, trial_, trial_gradient_;
  bool definite_ = false;
  double slope_ = 0;                            // of the energy against the direction
  double moved_mm_ = LinearSolver::kAnyChange;  // since the solver was updated
  RelaxationResult result_;
};

}  // namespace

RelaxationResult relax(const FilmEnergy& energy, const std::vector<std::uint8_t>& is_free,
                       const RelaxationOptions& options, LinearSolver& solver, VertexVector& u) {
  return Descent(energy, is_free, options, solver, u).run();
}

}  // namespace hydrodip
