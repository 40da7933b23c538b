#include "object/polygon.h"

#include <Eigen/Geometry>
#include <numeric>

namespace hydrodip {

namespace {

// Newell's normal: twice the area vector, right for concave polygons too.
Vec3 area_vector(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i] - corners[0];
    const Vec3 b = corners[(i + 1) % corners.size()] - corners[0];
    sum += a.cross(b);
  }
  return sum;
}

// Drops the coordinate along which the polygon faces most, keeping its turning sense positive.
std::vector<Vec2> flatten(const std::vector<Vec3>& corners) {
  const Vec3 normal = area_vector(corners);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  std::vector<Vec2> flat;
  for (const Vec3& p : corners) {
    flat.push_back(normal[axis] < 0 ? Vec2(p[j], p[i]) : Vec2(p[i], p[j]));
  }
  return flat;
}

bool is_ear(const std::vector<Vec2>& points, const std::vector<int>& ring, std::size_t at) {
  const std::size_t n = ring.size();
  const int before = ring[(at + n - 1) % n], tip = ring[at], after = ring[(at + 1) % n];
  const Vec2 &a = points[std::size_t(before)], &b = points[std::size_t(tip)],
             &c = points[std::size_t(after)];
  if (!(cross2(b - a, c - b) > 0)) return false;
  for (const int other : ring) {
    const Vec2& p = points[std::size_t(other)];
    if (other == before || other == tip || other == after || p == a || p == b || p == c) continue;
    if (cross2(b - a, p - a) >= 0 && cross2(c - b, p - b) >= 0 && cross2(a - c, p - c) >= 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<Vec3>& corners) {
  std::vector<std::array<int, 3>> triangles;
  if (corners.size() < 3) return triangles;
  std::vector<int> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0);
  const std::vector<Vec2> points = flatten(corners);
  // Going on from the last ear, rather than from the start, avoids a fan of slivers.
  std::size_t at = 1;
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    std::size_t ear = at % n;
    for (std::size_t tried = 0; tried < n; ++tried) {
      if (is_ear(points, ring, (at + tried) % n)) {
        ear = (at + tried) % n;
        break;
      }
    }
    triangles.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]});
    ring.erase(ring.begin() + std::ptrdiff_t(ear));
    at = ear + 1;
  }
  triangles.push_back({ring[0], ring[1], ring[2]});
  return triangles;
}

}  // namespace hydrodip
