#include "air/mouths.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "object/polygon.h"

namespace hydrodip {

namespace {

constexpr double kClosing_mm = 1e-4;

std::size_t enclosing(const std::vector<Loop>& loops, const Vec2& point) {
  return std::size_t(
      std::ranges::count_if(loops, [&](const Loop& loop) { return encloses(loop, point); }));
}

// The innermost loop around a point, or -1.
int innermost(const std::vector<Loop>& loops, const Vec2& point) {
  int best = -1;
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (encloses(loops[k], point) &&
        (best < 0 || std::abs(area(loops[k])) < std::abs(area(loops[std::size_t(best)]))))
      best = int(k);
  return best;
}

// One corner list for a loop and the holes in it: each hole is cut open at its rightmost corner,
// towards the nearest corner from which no side is in the way.
Loop joined(Loop outer, std::vector<Loop> holes) {
  if (area(outer) < 0) std::ranges::reverse(outer);
  const auto rightmost = [](const Loop& loop) {
    return std::ranges::max_element(loop, {}, [](const Vec2& p) { return p.x(); });
  };
  std::ranges::sort(holes, std::greater<>(), [&](const Loop& h) { return rightmost(h)->x(); });
  for (Loop& hole : holes) {
    if (area(hole) > 0) std::ranges::reverse(hole);
    std::rotate(hole.begin(), hole.begin() + (rightmost(hole) - hole.cbegin()), hole.end());
    const Vec2 from = hole.front();
    const auto crosses = [&](const Vec2& to) {
      for (std::size_t i = 0, j = outer.size() - 1; i < outer.size(); j = i++) {
        const Vec2 &a = outer[j], &b = outer[i];
        if (a == to || b == to) continue;
        if (cross2(to - from, a - from) * cross2(to - from, b - from) < 0 &&
            cross2(b - a, from - a) * cross2(b - a, to - a) < 0)
          return true;
      }
      return false;
    };
    std::vector<std::size_t> order(outer.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return (outer[i] - from).norm(); });
    std::size_t at = order.front();
    for (const std::size_t i : order)
      if (!crosses(outer[i])) {
        at = i;
        break;
      }
    Loop bridge = hole;
    bridge.push_back(hole.front());
    bridge.push_back(outer[at]);
    outer.insert(outer.begin() + std::ptrdiff_t(at) + 1, bridge.begin(), bridge.end());
  }
  return outer;
}

void add_polygon(const Loop& polygon, const Plane& plane, TriangleMesh& lids) {
  std::vector<Vec3> corners;
  for (const Vec2& p : polygon) corners.push_back(plane.lifted(p));
  const auto base = std::int32_t(lids.positions.size());
  for (const auto& t : triangulate(corners))
    if (area_vector(corners, t) != Vec3::Zero())  // else thin, along a cut
      lids.triangles.push_back({base + t[0], base + t[2], base + t[1]});
  lids.positions.insert(lids.positions.end(), corners.begin(), corners.end());
}

}  // namespace

Plane water_at(const Moment& moment) {
  if (!moment.moved) return {Vec3::UnitZ(), moment.level_mm};
  return {moment.turn.row(2).transpose(), moment.level_mm - moment.shift.z()};
}

std::optional<double> closing(const TriangleMesh& object, const Travel& travel,
                              const std::vector<Vec3>& points, double open_mm, double closed_mm,
                              double max_gap_mm) {
  const auto parts = [&](double travelled_mm) {
    const Plane plane = water_at(travel.at(travelled_mm));
    const std::vector<Loop> loops = section(object, plane, max_gap_mm);
    std::vector<std::size_t> around;
    around.reserve(points.size());
    for (const Vec3& p : points) around.push_back(enclosing(loops, plane.flat(p)));
    return around;
  };
  const std::vector<std::size_t> target = parts(closed_mm);
  const auto is_closed = [&](const std::vector<std::size_t>& around) {
    for (std::size_t k = 0; k < around.size(); ++k)
      if (around[k] < target[k] || around[k] == 0) return false;
    return true;
  };
  if (!is_closed(target)) return std::nullopt;
  if (is_closed(parts(open_mm))) return std::nullopt;
  while (closed_mm - open_mm > kClosing_mm) {
    const double middle = 0.5 * (open_mm + closed_mm);
    (is_closed(parts(middle)) ? closed_mm : open_mm) = middle;
  }
  return closed_mm;
}

std::size_t add_lids(const TriangleMesh& object, const Plane& plane,
                     const std::vector<Vec3>& points, const std::vector<Vec3>& others,
                     double max_gap_mm, TriangleMesh& lids) {
  const std::vector<Loop> loops = section(object, plane, max_gap_mm);
  std::set<int> closed;
  std::size_t found = 0;
  for (const Vec3& p : points) {
    const int around = innermost(loops, plane.flat(p));
    if (around < 0) continue;
    ++found;
    closed.insert(around);
  }
  for (const int outer : closed) {
    std::set<int> open;
    for (const Vec3& p : others) {
      const Vec2 at = plane.flat(p);
      if (!encloses(loops[std::size_t(outer)], at)) continue;
      // The outermost loop around it within this one.
      int hole = -1;
      for (std::size_t k = 0; k < loops.size(); ++k)
        if (int(k) != outer && encloses(loops[k], at) &&
            encloses(loops[std::size_t(outer)], loops[k].front()) &&
            (hole < 0 || std::abs(area(loops[k])) > std::abs(area(loops[std::size_t(hole)]))))
          hole = int(k);
      if (hole >= 0 && closed.count(hole) == 0) open.insert(hole);
    }
    std::vector<Loop> holes;
    holes.reserve(open.size());
    for (const int hole : open) holes.push_back(loops[std::size_t(hole)]);
    add_polygon(joined(loops[std::size_t(outer)], std::move(holes)), plane, lids);
  }
  return found;
}

}  // namespace hydrodip
