#include "dip/line_search.h"

namespace hydrodip {

Waterline::Point LineSearch::line_near(const Vec2& near, const Vec2& outside) const {
  const auto found = line.closest(near, kMaxJump * cell_mm);
  if (!found) return {near, outside, kWall};
  Waterline::Point point = *found;
  if (point.outward.dot(outside) < -0.7) {
    point.outward = -point.outward;
    point.steepness = -point.steepness;
  }
  return point;
}

Waterline::Point LineSearch::first_on_line(const Vec2& from, const Vec2& to) const {
  if (const auto leaving = line.exit(from, to)) return *leaving;
  const Vec2 outside = (to - from).normalized();
  const Waterline::Point near = line_near(from, outside);
  const bool behind = (near.position - from).dot(outside) < -0.1 * cell_mm;
  return behind ? line_near(to, outside) : near;
}

Waterline::Point LineSearch::next_on_line(const Vec2& from, const Vec2& floating,
                                          const Vec2& outward) const {
  if (const auto ahead = line.exit(from, floating))
    if ((ahead->position - from).norm() < kMaxJump * cell_mm) return *ahead;
  return line_near(from, outward);
}

}  // namespace hydrodip
