#include "dip/pace.h"

#include <algorithm>
#include <cmath>

#include "dip/flat_levels.h"
#include "dip/lowest_places.h"

namespace hydrodip {

namespace {

// How far the contact line should go in a step of dip.step_mm, in such steps, and the shortest step
// in them. Where the object rises so fast that steps may be longer, they grow so many times faster:
// there the film's strain decides.
constexpr double kLineAdvance = 4;
constexpr double kShortest = 1.0 / 8;
constexpr double kFaster = 4;

// By which factors steps may change from one to the next, and what their lengths beyond one step
// are multiples of, in steps: two dips that differ by little go in the same ones.
constexpr double kShrinks = 0.5, kGrows = 1.5, kMultiple = 1.0 / 8;

// Times the third power of dip.step_mm: how much elsewhere than even strain would have it film may
// lie that was laid in one step. The rule is of second order, so that this grows with the third
// power of a step's length, and over a whole dip with the second. Tears move film by far more.
constexpr double kUnforeseen_per_step3 = 0.4, kTornUnforeseen_per_step3 = 4;  // 1/mm2

// Where the water has just come to a new place, film changes as fast as that place grows: steps
// are no longer than this share of its height.
constexpr double kOfNewPlace = 0.1;

double in_multiples(double length_mm, double step_mm) {
  const double multiple_mm = kMultiple * step_mm;
  return std::floor(length_mm / multiple_mm + 1e-9) * multiple_mm;
}

}  // namespace

Pace::Pace(const DipSetting& setting)
    : step_mm_(setting.options.step_mm),
      length_mm_(setting.travel.length_mm()),
      longest_mm_(longest_step_mm(setting.options, setting.travel.trajectory())),
      told_mm_(setting.options.steps_at_mm) {
  if (!told_mm_.empty() || !setting.travel.trajectory().is_straight_down()) return;
  const double cell_mm = setting.film.cell_mm;
  jumps_mm_ = flat_levels(setting.positions, setting.triangles, cell_mm * cell_mm);
  if (grows()) lowest_mm_ = lowest_places(setting.positions, setting.triangles);
}

double Pace::shortest_mm() const { return kShortest * step_mm_; }

std::optional<double> Pace::next_end_mm(double at_mm, double to_mm) const {
  const bool last = !(to_mm < length_mm_);
  if (!(to_mm - at_mm > (last ? 0 : shortest_mm()))) return std::nullopt;
  if (!told_mm_.empty()) {
    const auto end = std::upper_bound(told_mm_.begin(), told_mm_.end(), at_mm);
    return end == told_mm_.end() ? length_mm_ : std::min(*end, length_mm_);
  }
  const double part_mm = longest_now_mm(at_mm);
  const double whole_mm = grows() ? length_mm_ : to_mm;
  // No sliver of a step at the end.
  const bool ends = whole_mm - at_mm < part_mm + 0.5 * std::min(part_mm, step_mm_);
  const double end_mm = ends ? whole_mm : at_mm + part_mm;
  return next_jump_mm(at_mm, end_mm).value_or(end_mm);
}

double Pace::longest_now_mm(double at_mm) const {
  double length_mm = std::max(pace_mm_, shortest_mm());
  if (length_mm <= step_mm_) return length_mm;
  const auto next = std::upper_bound(lowest_mm_.begin(), lowest_mm_.end(), at_mm + step_mm_);
  if (next != lowest_mm_.end()) length_mm = std::min(length_mm, *next - at_mm);
  const auto after = std::upper_bound(lowest_mm_.begin(), lowest_mm_.end(), at_mm);
  if (after != lowest_mm_.begin())
    length_mm = std::min(length_mm, in_multiples(kOfNewPlace * (at_mm - *(after - 1)), step_mm_));
  return std::max(length_mm, step_mm_);
}

// The first jump of the contact line on the way on, unless it is so near that a step would be too
// short.
std::optional<double> Pace::next_jump_mm(double at_mm, double end_mm) const {
  const auto jump = std::lower_bound(jumps_mm_.begin(), jumps_mm_.end(), at_mm + shortest_mm());
  if (jump == jumps_mm_.end() || !(*jump < end_mm)) return std::nullopt;
  const double left_mm = length_mm_ - *jump;
  return left_mm < shortest_mm() ? std::nullopt : std::optional(*jump);
}

void Pace::see(const Feet& feet, bool torn, double from_mm, double at_mm) {
  double by_line = kLineAdvance * feet.gentlest_rise();
  if (by_line > 1) by_line += (kFaster - 1) * (by_line - 1);
  pace_mm_ = std::min(longest_mm_, std::max(by_line, kShortest) * step_mm_);
  if (pace_mm_ <= step_mm_) return;
  const double allowed_mm =
      (torn ? kTornUnforeseen_per_step3 : kUnforeseen_per_step3) * step_mm_ * step_mm_ * step_mm_;
  const double least_mm = 1e-3 * allowed_mm;
  const double change = std::cbrt(allowed_mm / std::max(feet.unforeseen_mm(), least_mm));
  const double by_strain_mm = (at_mm - from_mm) * std::clamp(change, kShrinks, kGrows);
  pace_mm_ = std::max(step_mm_, in_multiples(std::min(pace_mm_, by_strain_mm), step_mm_));
}

}  // namespace hydrodip
