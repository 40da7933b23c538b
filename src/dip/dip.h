// The dip: lowers the object through the floating film (paper section 3.2) and says where every
// film vertex ends up.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/context.h"
#include "dip/foresight.h"
#include "dip/travel.h"
#include "elastic/linear_solver.h"
#include "elastic/material_law.h"
#include "film/film.h"
#include "object/surface.h"

namespace hydrodip {

enum class DipScheme {
  kContactLine,  // the default: the contact line is resolved inside triangles (docs/model.md)
  kPaper,        // the paper's four steps, literally
};

// How the film gets onto the object.
enum class DipMethod {
  kFull,        // lowered step by step, glued where it touches, by one of the schemes
  kSingleStep,  // baseline: draped at once, slides freely on the object, never glued
  kProjection,  // baseline: straight up, no elasticity
};

// No film bears a larger principal stretch, whatever it is said to bear.
inline constexpr double kMostStretch = 2;

struct FilmMaterial {
  double z_stretch = 0.65;    // vertical scale of the film's rest shape (contact angle)
  double poisson = 0;         // below 0.5
  double tear_stretch = 1.4;  // largest principal stretch the film bears; 0: never tears
  // Nobody has measured that limit. Up to the first of these film is safe, and stays sharp (a film
  // maker's patent, US8927061, states 1.30); from the second on no film holds.
  double safe_stretch = 1.3;
  double lost_stretch = 1.6;
  // Smallest principal stretch that the film bears without wrinkles. In truth so thin a sheet
  // buckles at once, but swelling film takes up a little, and wrinkles only show from a few percent
  // on: at 5 % they are a fifteenth as high as they are apart.
  double wrinkle_stretch = 0.95;
  // How film resists stretch, instead of the paper's Eq. 3 and `poisson`; null: those. Ink's
  // modulus multiplies it.
  std::shared_ptr<const MaterialLaw> law = {};
};

// Film torn to flaps or stretched too far may have no equilibrium that can be found, the less so
// once ink stiffens it. A dip that fails on more than this share of its way tells nothing.
inline constexpr double kMostFailedShare = 0.02;

struct DipOptions {
  double step_mm = 0.1;
  // Whether all steps are that long, but for parts where the contact line runs fast. If not, those
  // of a dip straight down grow, up to longest_step_mm(), where that costs no accuracy.
  bool even_steps = false;
  // Where the steps end that another dip on the same way has made (DipStatistics); empty: this one
  // finds out. Two dips in the same steps can be compared closer than they are accurate.
  std::vector<double> steps_at_mm = {};
  // What another dip like this one kept of its steps, to begin from, and what this one keeps for
  // the next: for dips one after another. Null: every step begins from the one before.
  std::shared_ptr<RelaxedSteps> relaxed_steps = {};
  DipMethod method = DipMethod::kFull;
  DipScheme scheme = DipScheme::kContactLine;  // of kFull
  FilmMaterial material;
  std::vector<double> modulus;  // per film triangle, relative; empty: uniform
  // Of the film's equilibrium; multigrid by default, others to compare with.
  std::function<std::unique_ptr<LinearSolver>(const FilmMesh&)> make_solver = make_multigrid_solver;
  // Per film triangle: how far the object has travelled when it lets go, whatever its stretch;
  // infinity: only when it is stretched well beyond what film bears. Empty: stretch alone decides.
  // What another dip found, so that two dips can be compared smoothly.
  std::vector<double> tears_at_mm;
  // Where film tears: dip twice more, in longer steps, to see what depends on how torn film falls.
  bool asks_what_moves = false;
  // A coat's dip asks that by itself (dip_object()), unless it is only a quick look.
  bool quick_look = false;
  // DippedFilm::moved_mm that another dip found; then that is not asked again.
  std::vector<double> moved_mm = {};
  // Where steps fail on more of the way than this share, dip() gives up.
  double failed_share_max = 1;
};

// Those of a dip with such options on that way: options.step_mm where steps do not grow.
double longest_step_mm(const DipOptions& options, const Trajectory& trajectory);

// How the computation went; sums over all steps.
struct DipStatistics {
  int steps = 0;
  std::vector<double> steps_at_mm;  // where they ended
  long iterations = 0;              // of all relaxations
  long unconverged_steps = 0;       // steps that ended at the iteration bound
  long failed_steps = 0;            // of these, still so far from equilibrium that print shows it
  double largest_residual_mm = 0;   // largest last update over all steps
};

struct DipResult {
  DippedFilm film;
  DipStatistics statistics;
};

// Sees the film at `steps` moments spread over the way, and before it as step 0: after each step
// if all are equally long, else about every longest_step_mm(). A step may end up to an eighth
// early, where a flat face comes to the water.
using DipObserver =
    std::function<void(int step, int steps, const Moment& moment, const std::vector<Vec3>& position,
                       const std::vector<VertexState>& state)>;

// `positions` and `triangles` are the object's, in the posed-object frame, and `surface` queries
// the same triangles. Other ways than straight down need the contact-line scheme. Throws DipError
// (exit code 3) if a step cannot be computed, InputError for options out of range, Cancelled.
DipResult dip(const SharedFilmMesh& film, const std::vector<Vec3>& positions,
              const std::vector<Triangle>& triangles, const Surface& surface,
              const Trajectory& trajectory, const DipOptions& options, const RunContext& context,
              const DipObserver& observe = {});

// The same on a mesh that nobody else holds.
inline DipResult dip(FilmMesh film, const std::vector<Vec3>& positions,
                     const std::vector<Triangle>& triangles, const Surface& surface,
                     const Trajectory& trajectory, const DipOptions& options,
                     const RunContext& context, const DipObserver& observe = {}) {
  return dip(std::make_shared<const FilmMesh>(std::move(film)), positions, triangles, surface,
             trajectory, options, context, observe);
}

}  // namespace hydrodip
