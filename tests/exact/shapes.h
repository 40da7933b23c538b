// Shapes for tests, in the posed-object frame: lowest point at z = 0.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "base/math.h"

namespace hydrodip::shapes {

struct Shape {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;

  std::int32_t add(double x, double y, double z) {
    positions.emplace_back(x, y, z);
    return static_cast<std::int32_t>(positions.size()) - 1;
  }
  void append(const Shape& other) {
    const auto shift = static_cast<std::int32_t>(positions.size());
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    for (Triangle t : other.triangles) {
      for (std::int32_t& v : t) v += shift;
      triangles.push_back(t);
    }
  }
};

// Surface of revolution about z of the meridian (radius(s), height(s)), s in [0, 1], from the
// bottom up; outward seen from below and outside. Poles are closed where the radius is zero.
inline Shape revolve(const std::function<Vec2(double)>& meridian, int rings, int segments) {
  Shape shape;
  std::vector<std::vector<std::int32_t>> ring;
  for (int i = 0; i <= rings; ++i) {
    const Vec2 p = meridian(double(i) / rings);
    std::vector<std::int32_t> row;
    if (p.x() < 1e-9) {
      row.assign(std::size_t(segments), shape.add(0, 0, p.y()));
    } else {
      for (int j = 0; j < segments; ++j) {
        const double angle = 2 * M_PI * j / segments;
        row.push_back(shape.add(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()));
      }
    }
    ring.push_back(row);
  }
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    for (std::size_t j = 0; j < std::size_t(segments); ++j) {
      const std::size_t k = (j + 1) % std::size_t(segments);
      const std::int32_t a = ring[i][j], b = ring[i][k], c = ring[i + 1][k], d = ring[i + 1][j];
      if (a != b) shape.triangles.push_back({a, b, c});
      if (c != d) shape.triangles.push_back({a, c, d});
    }
  return shape;
}

inline Shape sphere_bowl(double radius, double rim_radius, int rings = 300, int segments = 360) {
  const double end = std::asin(rim_radius / radius);
  return revolve(
      [=](double s) { return Vec2(radius * std::sin(s * end), radius * (1 - std::cos(s * end))); },
      rings, segments);
}

inline Shape full_sphere(double radius, int rings = 120, int segments = 160) {
  return revolve(
      [=](double s) {
        return Vec2(radius * std::sin(M_PI * s), radius * (1 - std::cos(M_PI * s)));
      },
      rings, segments);
}

inline Shape cone(double radius, double tan_theta, int rings = 60, int segments = 360) {
  return revolve([=](double s) { return Vec2(radius * s, radius * s * tan_theta); }, rings,
                 segments);
}

// Two planes that meet in a line along y at x = 0, z = 0, rising to both sides.
inline Shape wedge(double half_width, double half_length, double tan_theta) {
  Shape shape;
  const double z = half_width * tan_theta;
  const auto a = shape.add(0, -half_length, 0), b = shape.add(0, half_length, 0);
  const auto c = shape.add(half_width, -half_length, z), d = shape.add(half_width, half_length, z);
  const auto e = shape.add(-half_width, -half_length, z),
             f = shape.add(-half_width, half_length, z);
  shape.triangles = {{a, b, d}, {a, d, c}, {a, e, f}, {a, f, b}};
  return shape;
}

// Four planes that meet in a tip at the origin and rise to the sides of a square.
inline Shape pyramid(double half_width, double tan_theta) {
  Shape shape;
  const double z = half_width * tan_theta;
  const auto tip = shape.add(0, 0, 0);
  const auto a = shape.add(-half_width, -half_width, z), b = shape.add(half_width, -half_width, z),
             c = shape.add(half_width, half_width, z), d = shape.add(-half_width, half_width, z);
  shape.triangles = {{tip, b, a}, {tip, c, b}, {tip, d, c}, {tip, a, d}};
  return shape;
}

// The lower part of a circular cylinder along y, up to `angle` from straight down on both sides.
inline Shape trough(double radius, double half_length, double angle, int facets) {
  Shape shape;
  for (int n = 0; n <= facets; ++n) {
    const double at = angle * (2.0 * n / facets - 1);
    for (const double y : {-half_length, half_length})
      shape.add(radius * std::sin(at), y, radius * (1 - std::cos(at)));
  }
  for (std::int32_t a = 0; a < 2 * facets; a += 2) {
    shape.triangles.push_back({a, a + 1, a + 3});
    shape.triangles.push_back({a, a + 3, a + 2});
  }
  return shape;
}

inline Shape box(const Vec3& low, const Vec3& high) {
  Shape shape;
  for (int k = 0; k < 8; ++k)
    shape.add(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z());
  shape.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return shape;
}

}  // namespace hydrodip::shapes
