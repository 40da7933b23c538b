#include "air/pocket_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "base/disjoint_sets.h"
#include "base/run_scope.h"
#include "object/edges.h"

namespace hydrodip {

namespace {

using Polygon = std::vector<Vec3>;

// What cells get wrong at edges leaves so much of a piece in no doubt.
constexpr double kNearlyAll = 0.8;
// A rim that is not quite level does not join inside and outside.
constexpr double kRim_mm = 2e-3;
// Cosine between normals: a crease from 30 degrees on.
constexpr double kCrease = 0.866;

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

Polygon PocketSurface::above(std::size_t triangle, const Plane& water) const {
  Polygon polygon;
  for (const std::int32_t v : mesh_.triangles[triangle])
    polygon.push_back(mesh_.positions[std::size_t(v)]);
  return clipped(polygon, water, 1);
}

std::vector<PocketSurface::Share> PocketSurface::shares(const Plane& water, const Holds& holds,
                                                        double reach_mm) const {
  std::vector<Share> shares(mesh_.triangles.size());
  CheckEvery check(1 << 12);
  for (std::size_t t = 0; t < shares.size(); ++t) {
    check();
    const Polygon polygon = above(t, water);
    if (polygon.size() < 3) continue;
    const Vec3 normal = face_normal(mesh_, int(t));
    for_fan(polygon, [&](double area, const Vec3& middle) {
      if (!(area > 0)) return;
      shares[t].above_mm2 += area;
      if (holds(middle + reach_mm * normal, middle, normal) ||
          (!is_closed() && holds(middle - reach_mm * normal, middle, -normal)))
        shares[t].in_pocket_mm2 += area;
    });
  }
  return shares;
}

std::vector<bool> PocketSurface::belonging(const Plane& water, const std::vector<Share>& shares,
                                           bool& is_whole) const {
  const std::size_t count = mesh_.triangles.size();
  const auto height = [&](std::int32_t v) { return water.height(mesh_.positions[std::size_t(v)]); };
  DisjointSets pieces(count), patches(count);
  for (const Shared& shared : shared_) {
    if (!(std::max(height(shared.a), height(shared.b)) > kRim_mm)) continue;
    pieces.join(shared.one, shared.other);
    if (face_normal(mesh_, shared.one).dot(face_normal(mesh_, shared.other)) > kCrease)
      patches.join(shared.one, shared.other);
  }
  // Per triangle, what is true of the whole set that it is in.
  const auto summed = [&](DisjointSets& sets) {
    std::vector<Share> sums(count);
    for (std::size_t t = 0; t < count; ++t) {
      Share& sum = sums[sets.find(std::int32_t(t))];
      sum.above_mm2 += shares[t].above_mm2;
      sum.in_pocket_mm2 += shares[t].in_pocket_mm2;
    }
    return sums;
  };
  const std::vector<Share> of_pieces = summed(pieces), of_patches = summed(patches);
  std::vector<bool> belongs(count, false);
  for (std::size_t t = 0; t < count; ++t) {
    if (!(shares[t].above_mm2 > 0)) continue;
    const Share* const piece = &of_pieces[pieces.find(std::int32_t(t))];
    for (const Share* share : {piece, &of_patches[patches.find(std::int32_t(t))], &shares[t]}) {
      const double part = share->in_pocket_mm2 / share->above_mm2;
      belongs[t] = part > 0.5;
      if (belongs[t] && share != piece) is_whole = false;
      if (part > kNearlyAll || part < 1 - kNearlyAll) break;
    }
  }
  return belongs;
}

PocketSurface::Part PocketSurface::part(const Plane& water, const std::vector<Plane>& levels,
                                        const Holds& holds, double reach_mm) const {
  Part part;
  const std::vector<bool> belongs = belonging(water, shares(water, holds, reach_mm), part.is_whole);
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!belongs[t]) continue;
    const Polygon polygon = above(t, water);
    part.triangles.push_back(std::int32_t(t));
    const double slope = water.up.dot(face_normal(mesh_, int(t)));
    for_fan(polygon, [&](double area, const Vec3& middle) {
      part.area_mm2 += area;
      part.volume_mm3 -= area * slope * water.height(middle);
    });
    for (const Vec3& p : polygon)
      if (water.height(p) > highest) {
        highest = water.height(p);
        part.top = p;
      }
    // Above all levels lies what never gets under water.
    Polygon dry = polygon;
    for (std::size_t k = 0; k < levels.size() && dry.size() > 2; ++k)
      dry = clipped(dry, levels[k], 1);
    for_fan(dry, [&](double area, const Vec3&) { part.area_mm2 -= area; });
  }
  return part;
}

}  // namespace hydrodip
