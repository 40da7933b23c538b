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
  const double length = (to - from).norm();
  const Vec2 outside = (to - from).normalized();
  Waterline::Point near = line_near(from, outside);
  const bool behind = (near.position - from).dot(outside) < -0.1 * cell_mm;
  if (!behind) return near;
  if (!line.closest(to, length)) return {from, outside, kWall};
  return line_near(to, outside);
}

std::optional<Waterline::Point> LineSearch::ahead(const Vec2& from, const Vec2& floating) const {
  auto found = line.exit(from, floating);
  if (found && (found->position - from).norm() < kMaxJump * cell_mm) return found;
  return std::nullopt;
}

double LineSearch::facing(const Vec2& from, const Vec2& outward) const {
  const auto near = line.closest(from, kMaxJump * cell_mm);
  return near ? near->outward.dot(outward) : 0;
}

}  // namespace hydrodip
