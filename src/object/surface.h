// Geometric queries on a triangle surface: the only place that knows Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "object/object.h"

namespace hydrodip {

struct SurfaceHit {
  int triangle = -1;
  double u = 0, v = 0;  // barycentric: weights (1 - u - v, u, v)
  double t = 0;         // distance along the ray in units of |direction|; or distance to the point
};

// Immutable once built, safe to query from many threads. Queries run in Embree's single precision
// to find the triangle, then u, v and t are recomputed in double from that triangle, so a hit lies
// on the surface to about 1e-9 mm.
class Surface {
 public:
  // Degenerate triangles are never hit. What it takes to answer is made while the caller goes on;
  // the first question waits for it. Both throw Cancelled, as check_cancelled() does.
  explicit Surface(std::shared_ptr<const TriangleMesh> mesh);
  // Of copies.
  Surface(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  // First hit of origin + t direction with t in [t_min, t_max], either side of a triangle. None
  // where one of them is no number, or further than any object.
  std::optional<SurfaceHit> first_hit(const Vec3& origin, const Vec3& direction, double t_min,
                                      double t_max) const;

  // Whether there is such a hit; found sooner than which is the first.
  bool is_hit(const Vec3& origin, const Vec3& direction, double t_min, double t_max) const;

  // Closest point within max_distance; SurfaceHit::t is its distance.
  std::optional<SurfaceHit> closest_point(const Vec3& point, double max_distance) const;

  // All triangles of which a part is within the distance, and perhaps some others near it, in any
  // order, in place of what `triangles` held.
  void triangles_near(const Vec3& point, double max_distance, std::vector<int>& triangles) const;

  Vec3 position(const SurfaceHit& hit) const;
  // Unit normal of the hit triangle.
  Vec3 normal(const SurfaceHit& hit) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Per point: the surface's unit normal where it is nearest; zero if it is further away than a
// millimetre, or the point is not wanted.
std::vector<Vec3> normals_near(const Surface& surface, const std::vector<Vec3>& points,
                               const std::vector<std::uint8_t>& wanted);

}  // namespace hydrodip
