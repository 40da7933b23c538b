#include "air/pocket_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/disjoint_sets.h"
#include "base/run_scope.h"
#include "object/edges.h"

namespace hydrodip {

namespace {

using Polygon = std::vector<Vec3>;

// What of it lies on the side where sign * height is above zero.
Polygon clipped(const Polygon& polygon, const Plane& plane, double sign) {
  Polygon result;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const double hj = sign * plane.height(polygon[j]), hi = sign * plane.height(polygon[i]);
    if ((hj > 0) != (hi > 0))
      result.push_back(polygon[j] + hj / (hj - hi) * (polygon[i] - polygon[j]));
    if (hi > 0) result.push_back(polygon[i]);
  }
  return result;
}

// Calls visit(area, middle) for each triangle of a fan.
template <typename Visit>
void for_fan(const Polygon& polygon, const Visit& visit) {
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec3 &a = polygon[0], &b = polygon[k - 1], &c = polygon[k];
    visit(0.5 * (b - a).cross(c - a).norm(), Vec3((a + b + c) / 3));
  }
}

}  // namespace

PocketSurface::PocketSurface(const TriangleMesh& mesh) : mesh_(mesh) {
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    const std::int32_t a = sides[begin].low_vertex(), b = sides[begin].high_vertex();
    for (std::size_t i = begin + 1; i < end; ++i)
      shared_.push_back({a, b, face_of(sides[begin]), face_of(sides[i])});
    if (end == begin + 1) open_edges_.push_back({a, b});
  });
}

PocketSurface::Part PocketSurface::part(
    const Plane& water, const std::optional<Plane>& below,
    const std::function<bool(const Vec3&, const Vec3&, const Vec3&)>& holds,
    double reach_mm) const {
  DisjointSets pieces(mesh_.triangles.size());
  const auto height = [&](std::int32_t v) { return water.height(mesh_.positions[std::size_t(v)]); };
  for (const Shared& shared : shared_)
    if (std::max(height(shared.a), height(shared.b)) > 0) pieces.join(shared.one, shared.other);

  std::vector<double> all(mesh_.triangles.size(), 0), in_pocket(mesh_.triangles.size(), 0);
  const auto above = [&](std::size_t t) {
    Polygon polygon;
    for (const std::int32_t v : mesh_.triangles[t])
      polygon.push_back(mesh_.positions[std::size_t(v)]);
    return clipped(polygon, water, 1);
  };
  const auto normal_of = [&](std::size_t t) {
    const auto& v = mesh_.triangles[t];
    const Vec3& a = mesh_.positions[std::size_t(v[0])];
    return Vec3((mesh_.positions[std::size_t(v[1])] - a)
                    .cross(mesh_.positions[std::size_t(v[2])] - a)
                    .normalized());
  };
  CheckEvery check(1 << 12);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    check();
    const auto& v = mesh_.triangles[t];
    if (height(v[0]) <= 0 && height(v[1]) <= 0 && height(v[2]) <= 0) continue;
    const Vec3 normal = normal_of(t);
    const auto piece = pieces.find(std::int32_t(t));
    for_fan(above(t), [&](double area, const Vec3& middle) {
      if (!(area > 0)) return;
      all[piece] += area;
      if (holds(middle + reach_mm * normal, middle, normal) ||
          (!is_closed() && holds(middle - reach_mm * normal, middle, -normal)))
        in_pocket[piece] += area;
    });
  }

  Part part;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto piece = pieces.find(std::int32_t(t));
    if (!(in_pocket[piece] > 0.5 * all[piece])) continue;
    Polygon polygon = above(t);
    if (polygon.size() < 3) continue;
    part.triangles.push_back(std::int32_t(t));
    const double slope = water.up.dot(normal_of(t));
    for_fan(polygon, [&](double area, const Vec3& middle) {
      part.volume_mm3 -= area * slope * water.height(middle);
    });
    for (const Vec3& p : polygon)
      if (water.height(p) > highest) {
        highest = water.height(p);
        part.top = p;
      }
    if (below) polygon = clipped(polygon, *below, -1);
    for_fan(polygon, [&](double area, const Vec3&) { part.area_mm2 += area; });
  }
  return part;
}

}  // namespace hydrodip
