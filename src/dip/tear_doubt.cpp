#include "dip/tear_doubt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"

namespace hydrodip {

namespace {

// Steps are that many times longer, up to a length: what moves hardly depends on them. The film is
// the same: on coarser film tears are as wide as its triangles, and move what they would not.
constexpr double kLonger = 10;
constexpr double kLongestStep_mm = 1;
// Film that one of them has lost lies nowhere.
constexpr double kNowhere_mm = 10;

// Per vertex: whether any film there is left.
std::vector<std::uint8_t> left_over(const DippedFilm& film) {
  std::vector<std::uint8_t> left(film.position.size(), 0);
  for (std::size_t t = 0; t < film.torn.size(); ++t)
    if (!std::isfinite(film.torn_at_mm[t]))
      for (std::int32_t v : film.mesh().triangles[t]) left[std::size_t(v)] = 1;
  return left;
}

// How far the film of a dip lies elsewhere if torn film falls otherwise. DipError: nobody can tell.
std::vector<double> moved_in_others(const DippedFilm& dipped, const std::vector<Vec3>& positions,
                                    const std::vector<Triangle>& triangles, const Surface& surface,
                                    const Trajectory& trajectory, const DipOptions& options,
                                    const RunContext& context) {
  DipOptions other = options;
  other.step_mm = longer_step_mm(options.step_mm);
  other.asks_what_moves = false;
  other.failed_share_max = kMostFailedShare;
  other.moved_mm.clear();
  other.relaxed_steps.reset();
  const auto in_longer_steps = [&](const DipOptions& how, const RunContext& own) {
    return dip(dipped.shared_mesh, positions, triangles, surface, trajectory, how, own).film;
  };
  const RunContext own = context.quiet();
  // Steps that differ move film as well.
  const DippedFilm middle = other.step_mm > options.step_mm ? in_longer_steps(other, own) : dipped;
  const FilmMaterial& material = options.material;
  const std::array<double, 2> limits = {std::min(material.safe_stretch, material.tear_stretch),
                                        std::max(material.lost_stretch, material.tear_stretch)};
  std::array<DippedFilm, 2> fallen;
  std::vector<std::function<void()>> tasks;
  for (std::size_t i = 0; i < 2; ++i)
    tasks.emplace_back([&, i] {
      DipOptions how = other;
      how.material.safe_stretch = how.material.tear_stretch = how.material.lost_stretch = limits[i];
      fallen[i] = in_longer_steps(how, own.quiet().with_threads(std::max(1, own.threads() / 2)));
    });
  own.side_by_side("asking what moves", tasks);
  std::vector<double> moved(dipped.position.size(), 0);
  for (const DippedFilm& film : fallen) {
    const std::vector<std::uint8_t> left = left_over(film);
    for (std::size_t v = 0; v < moved.size(); ++v) {
      const double way = (film.position[v] - middle.position[v]).norm();
      moved[v] = std::max(moved[v], left[v] ? std::min(way, kNowhere_mm) : kNowhere_mm);
    }
  }
  return moved;
}

}  // namespace

double longer_step_mm(double step_mm) {
  return std::min(kLonger * step_mm, std::max(step_mm, kLongestStep_mm));
}

double first_let_go_mm(const DippedFilm& dipped) {
  double first = std::numeric_limits<double>::infinity();
  for (const double at : dipped.torn_at_mm) first = std::min(first, at);
  return first;
}

std::vector<double> moved_by_tears(const DippedFilm& dipped, const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles, const Surface& surface,
                                   const Trajectory& trajectory, const DipOptions& options,
                                   const RunContext& context) {
  std::vector<double> moved;
  try {
    moved = moved_in_others(dipped, positions, triangles, surface, trajectory, options, context);
  } catch (const DipError&) {
    moved.assign(dipped.position.size(), kNowhere_mm);
  }
  if (trajectory.is_straight_down()) {
    const double first_mm = first_let_go_mm(dipped);
    for (std::size_t v = 0; v < moved.size(); ++v)
      if (dipped.state[v] == VertexState::kAttached && dipped.position[v].z() < first_mm)
        moved[v] = 0;
  }
  return moved;
}

}  // namespace hydrodip
