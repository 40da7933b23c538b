#include "elastic/relaxation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"

namespace hydrodip {

namespace {

constexpr int kMaxHalvings = 30;
// A step that still turns a triangle over after so many is blocked by it.
constexpr int kBlockedHalvings = 8;
// Share of the slope that may be left at the end of a step that is taken without further question.
constexpr double kFlattened = 0.5;
// Where more is left, so many other lengths are tried, each at most so many times the one before.
constexpr int kMostSecants = 2;
constexpr double kLongestSecant = 8;
// What is left of an error after one iteration, until the second shows.
constexpr double kFirstContraction = 0.2;

// Entries of a field at a time, and what they add up to.
constexpr std::size_t kGrain = 6144;

// Calls body(first, last entry, sums) for parts of a field of this many entries; sums are added up
// in the parts' order.
template <typename Body>
kernels::Stride over_parts(std::size_t entries, const Body& body) {
  std::vector<kernels::Stride> partial((entries + kGrain - 1) / kGrain, kernels::Stride{});
  parallel_for(entries, kGrain, [&](std::size_t begin, std::size_t end) {
    body(begin, end, partial[begin / kGrain]);
  });
  kernels::Stride all{};
  for (const kernels::Stride& part : partial) {
    all.slope += part.slope;
    all.largest_square = std::max(all.largest_square, part.largest_square);
  }
  return all;
}

}  // namespace

// The descent and what it carries from one iteration to the next.
class Descent {
 public:
  Descent(Relaxation& fields, const std::vector<std::uint8_t>& is_free,
          const RelaxationOptions& options)
      : energy_(fields.energy_),
        solver_(fields.solver_),
        is_free_(is_free),
        options_(options),
        entries_(energy_.grid().layout().entries()),
        u_(fields.u_),
        gradient_(fields.gradient_),
        trial_(fields.trial_),
        trial_gradient_(fields.trial_gradient_),
        mask_(fields.mask_) {}

  RelaxationResult run() {
    const bool turned_over = energy_.gradient(u_, mask_, gradient_) > 0;
    if (turned_over && options_.otherwise) {
      energy_.grid().to_grid(*options_.otherwise, u_);
      energy_.gradient(u_, mask_, gradient_);
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
      if (result_.iterations > 1) contraction = std::min(1.0, update_ / result_.last_update_mm);
      result_.last_update_mm = update_;
      if (result_.iterations == 1) set_tolerance();
      // What the next iterations would still change.
      result_.converged = update_ * contraction <= tolerance_mm_;
      if (result_.converged && take_last_step()) return result_;
      if (!take_flat_step() && !search()) return result_;
    }
    return result_;
  }

 private:
  void set_tolerance() {
    const double loose = options_.tolerance_per_way2 * update_ * update_;
    tolerance_mm_ = std::max(options_.tolerance_mm, std::min(loose, options_.loosest_mm));
  }

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

  // The whole step is tried first, so it is taken on the way.
  bool goes_down() {
    const auto direction = solver_.direction(gradient_);
    if (!direction) return false;
    direction_ = *direction;
    const kernels::Stride sums = move_to(1);
    slope_ = sums.slope;
    update_ = std::sqrt(sums.largest_square);
    return slope_ >= 0;
  }

  // Slope and longest move along the direction are found on the way.
  kernels::Stride move_to(double step) {
    return over_parts(entries_, [&](std::size_t begin, std::size_t end, kernels::Stride& sums) {
      sums = kernels::best().go(begin, end, u_, direction_.way, step * direction_.length, gradient_,
                                trial_);
    });
  }

  // So near the minimum, any step that turns nothing over will do.
  bool take_last_step() {
    if (energy_.any_inverted(trial_)) return false;
    u_.swap(trial_);
    return true;
  }

  // The energy is convex enough along the way if its slope has become small at the end: then the
  // step is taken without asking for the energy itself. If it has not, the slopes tell a better
  // length: film that hangs by little is far softer or stiffer along some ways than it was when the
  // solver looked.
  bool take_flat_step() {
    struct Place {
      double step, slope;
    };
    Place before{0, 1}, beyond{0, 0};  // where the energy still falls, and where it rises
    double step = 1;
    for (int secants = 0;; ++secants) {
      if (energy_.gradient(trial_, mask_, trial_gradient_) > 0) return false;
      const double slope = slope_left();
      if (std::abs(slope) <= kFlattened) break;
      if (secants == kMostSecants) return false;
      (slope > 0 ? before : beyond) = {step, slope};
      if (beyond.step > 0)
        step = before.step +
               (beyond.step - before.step) * before.slope / (before.slope - beyond.slope);
      else
        step *= slope < 1 ? std::min(1 / (1 - slope), kLongestSecant) : kLongestSecant;
      move_to(step);
    }
    u_.swap(trial_);
    gradient_.swap(trial_gradient_);
    result_.last_update_mm = step * update_;
    moved_mm_ += result_.last_update_mm;
    return true;
  }

  // Of the energy along the direction at trial_, as a share of that at u_.
  double slope_left() const {
    const kernels::Stride sums =
        over_parts(entries_, [&](std::size_t begin, std::size_t end, kernels::Stride& part) {
          part.slope = kernels::best().dot_field(begin, end, trial_gradient_, direction_.way);
        });
    return direction_.length * sums.slope / slope_;
  }

  // Halves the step until the energy falls; far from the minimum, where the exact Hessian may
  // mislead, once more along the definite direction.
  bool search() {
    if (line_search()) return true;
    return result_.blocked.empty() && !definite_ && find_definite_direction() && line_search();
  }

  bool line_search() {
    const double before = energy_.value(u_);
    // What rounding alone may add: near the minimum, an energy difference cannot be resolved.
    const double noise = 1e-13 * std::abs(before);
    double step = 1;
    for (int halving = 0; halving < kMaxHalvings; ++halving, step *= 0.5) {
      move_to(step);
      if (energy_.any_inverted(trial_)) {
        if (halving < kBlockedHalvings) continue;
        result_.blocked = energy_.inverted(trial_);
        return false;
      }
      if (energy_.value(trial_) > before - 1e-4 * step * slope_ + noise) continue;
      u_.swap(trial_);
      energy_.gradient(u_, mask_, gradient_);
      result_.last_update_mm = step * update_;
      moved_mm_ += result_.last_update_mm;
      return true;
    }
    return false;
  }

  const FilmEnergy& energy_;
  LinearSolver& solver_;
  const std::vector<std::uint8_t>& is_free_;
  const RelaxationOptions& options_;
  const std::size_t entries_;  // of fields
  GridField &u_, &gradient_, &trial_, &trial_gradient_;
  SearchDirection direction_{};
  const GridArray<double>& mask_;
  bool definite_ = false;
  double tolerance_mm_ = 0;
  double slope_ = 0;                            // of the energy against the direction
  double update_ = 0;                           // longest move in the direction, mm
  double moved_mm_ = LinearSolver::kAnyChange;  // since the solver was updated
  RelaxationResult result_;
};

Relaxation::Relaxation(const FilmEnergy& energy, LinearSolver& solver)
    : energy_(energy),
      solver_(solver),
      u_(energy.grid().layout()),
      gradient_(u_),
      trial_(u_),
      trial_gradient_(u_),
      mask_(energy.grid().layout().entries()) {}

RelaxationResult Relaxation::run(const std::vector<std::uint8_t>& is_free,
                                 const RelaxationOptions& options, VertexVector& u) {
  energy_.grid().to_grid(u, u_);
  RelaxationResult result = run(is_free, options);
  energy_.grid().to_vertices(u_, u);
  return result;
}

RelaxationResult Relaxation::run(const std::vector<std::uint8_t>& is_free,
                                 const RelaxationOptions& options) {
  energy_.grid().to_mask(is_free, mask_);
  return Descent(*this, is_free, options).run();
}

}  // namespace hydrodip
