#include "dip/line_search.h"

#include <algorithm>

namespace hydrodip {

std::optional<Waterline::Point> LineSearch::near(const Vec2& place) const {
  return line.closest(place, kMaxJump * cell_mm);
}

Waterline::Point LineSearch::outwards(Waterline::Point point, const Vec2& outside) {
  if (point.outward.dot(outside) < -0.7) {
    point.outward = -point.outward;
    point.steepness = -point.steepness;
  }
  return point;
}

Waterline::Point LineSearch::line_near(const Vec2& place, const Vec2& outside) const {
  const auto found = near(place);
  return found ? outwards(*found, outside) : Waterline::Point{place, outside, kWall};
}

Waterline::Point LineSearch::first_on_line(const Vec2& from, const Vec2& to) const {
  if (const auto leaving = line.exit(from, to)) return *leaving;
  const Vec2 outside = (to - from).normalized();
  Waterline::Point beside = line_near(from, outside);
  const bool behind = (beside.position - from).dot(outside) < -0.1 * cell_mm;
  if (!behind) return beside;
  const auto beyond = line.closest(to, std::min((to - from).norm(), kMaxJump * cell_mm));
  return beyond ? outwards(*beyond, outside) : Waterline::Point{from, outside, kWall};
}

std::optional<Waterline::Point> LineSearch::ahead(const Vec2& from, const Vec2& floating) const {
  auto found = line.exit(from, floating);
  if (found && (found->position - from).norm() < kMaxJump * cell_mm) return found;
  return std::nullopt;
}

}  // namespace hydrodip
