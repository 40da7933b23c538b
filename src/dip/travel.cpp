#include "dip/travel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/error.h"

namespace hydrodip {

namespace {

// A path is measured in so many parts from keyframe to keyframe, where its speed changes, and in so
// many at least in all.
constexpr int kPartsPerPiece = 16, kFewestParts = 64;
// Halvings of the part in which the object first touches.
constexpr int kHalvings = 48;
// Rounding, at the start, of an object that just touches.
constexpr double kStartSlack_mm = 1e-3;

Moment moment_of(const Trajectory& trajectory, double t) {
  const Eigen::Isometry3d bath = trajectory.bath_from_object(t);
  const double level = trajectory.at(t).lower_mm;
  return {0, t, level, true, bath.linear(), bath.translation() + Vec3(0, 0, level)};
}

double lowest(const Moment& moment, const std::vector<Vec3>& positions) {
  double least = 1e300;
  for (const Vec3& p : positions) least = std::min(least, moment.height(p));
  return least;
}

// The corners of triangles that are in the water, if only in part.
std::vector<std::uint8_t> wet_vertices(const Moment& moment, const std::vector<Vec3>& positions,
                                       const std::vector<Triangle>& triangles) {
  std::vector<std::uint8_t> below(positions.size());
  for (std::size_t v = 0; v < below.size(); ++v) below[v] = moment.height(positions[v]) < 0;
  std::vector<std::uint8_t> wet = below;
  for (const Triangle& t : triangles) {
    const bool dips = std::ranges::any_of(t, [&](std::int32_t v) { return below[std::size_t(v)]; });
    for (std::int32_t v : t) wet[std::size_t(v)] |= std::uint8_t(dips);
  }
  return wet;
}

// Of the wet vertices, in the bath.
double longest_way(const Moment& from, const Moment& to, const std::vector<Vec3>& positions,
                   const std::vector<std::uint8_t>& wet) {
  const Mat3 turn = to.turn - from.turn;
  const Vec3 shift = to.shift - from.shift - Vec3(0, 0, to.level_mm - from.level_mm);
  double longest2 = 0;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (wet[v]) longest2 = std::max(longest2, (turn * positions[v] + shift).squaredNorm());
  return std::sqrt(longest2);
}

// Between a moment in the air and one in the water.
double touching(const Trajectory& trajectory, double dry, double wet,
                const std::vector<Vec3>& positions) {
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (dry + wet);
    (lowest(moment_of(trajectory, middle), positions) < 0 ? wet : dry) = middle;
  }
  return dry;
}

// The value at x, linear between the places.
double interpolated(const std::vector<double>& places, const std::vector<double>& values,
                    double x) {
  const auto after = std::ranges::upper_bound(places, x) - places.begin();
  if (after == 0) return values.front();
  if (after == std::ptrdiff_t(places.size())) return values.back();
  const auto b = std::size_t(after), a = b - 1;
  return std::lerp(values[a], values[b], (x - places[a]) / (places[b] - places[a]));
}

}  // namespace

Travel::Travel(const Trajectory& trajectory, const std::vector<Vec3>& positions,
               const std::vector<Triangle>& triangles)
    : trajectory_(trajectory) {
  if (!trajectory_.is_straight_down()) {
    measure(positions, triangles);
    return;
  }
  length_ = trajectory_.depth_mm();
  const std::size_t pieces = trajectory_.keyframes().size() - 1;
  for (std::size_t k = 0; k <= pieces; ++k) {
    t_.push_back(double(k) / double(pieces));
    travelled_.push_back(trajectory_.keyframes()[k].lower_mm);
  }
}

void Travel::measure(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  const int pieces = int(trajectory_.keyframes().size()) - 1;
  const int parts = pieces * std::max(kPartsPerPiece, (kFewestParts + pieces - 1) / pieces);
  const double deep = -lowest(moment_of(trajectory_, 0), positions);
  if (deep > kStartSlack_mm)
    throw InputError(fmt::format(
        "the path begins with the object {:.3g} mm deep in the water: begin it {:.3g} mm higher",
        deep, deep));
  std::vector<double> t = {0};
  std::vector<double> travelled = {0};
  std::vector<std::uint8_t> wet;
  for (int n = 1; n <= parts; ++n) {
    const double next = double(n) / parts;
    const Moment to = moment_of(trajectory_, next);
    if (wet.empty()) {
      if (!(lowest(to, positions) < 0)) {
        t.back() = next;
        continue;
      }
      t.back() = touching(trajectory_, t.back(), next, positions);
      wet = wet_vertices(moment_of(trajectory_, t.back()), positions, triangles);
    }
    const std::vector<std::uint8_t> wet_then = wet_vertices(to, positions, triangles);
    for (std::size_t v = 0; v < wet.size(); ++v) wet[v] |= wet_then[v];
    const double way = longest_way(moment_of(trajectory_, t.back()), to, positions, wet);
    wet = wet_then;
    if (!(way > 0)) continue;
    t.push_back(next);
    travelled.push_back(travelled.back() + way);
  }
  if (travelled.size() < 2) throw InputError("the path never brings the object into the water");
  t_ = std::move(t);
  travelled_ = std::move(travelled);
  length_ = travelled_.back();
}

Moment Travel::at(double travelled_mm) const {
  const double t = interpolated(travelled_, t_, travelled_mm);
  if (trajectory_.is_straight_down()) return Moment::at_depth(travelled_mm, t);
  Moment moment = moment_of(trajectory_, t);
  moment.travelled_mm = travelled_mm;
  return moment;
}

}  // namespace hydrodip
