// Hollow solids of revolution, of which everything is known.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "exact/shapes.h"
#include "object/object.h"

namespace hydrodip::cups {

constexpr int kSegments = 96;
constexpr double kRad = std::numbers::pi / 180;

// Of a regular polygon with its corners on a circle.
inline double polygon_area(double radius) {
  return 0.5 * kSegments * radius * radius * std::sin(2 * std::numbers::pi / kSegments);
}
inline double polygon_outline(double radius) {
  return 2 * kSegments * radius * std::sin(std::numbers::pi / kSegments);
}

// Closed profiles (radius, height) turn into solids; the way round that faces outwards.
inline shapes::Shape turned(std::vector<Vec2> profile) {
  double twice = 0;
  for (std::size_t i = 0, j = profile.size() - 1; i < profile.size(); j = i++)
    twice += cross2(profile[j], profile[i]);
  if (twice < 0) std::reverse(profile.begin(), profile.end());
  if (profile.front() != profile.back() && profile.front().x() > 0)
    profile.push_back(profile.front());
  const int rings = int(profile.size()) - 1;
  return shapes::revolve([&](double s) { return profile[std::size_t(std::lround(s * rings))]; },
                         rings, kSegments);
}

// Mouth down: 18 mm outer and 15 mm inner radius, 25 mm deep.
inline const std::vector<Vec2> kCup = {{0, 28}, {18, 28}, {18, 0}, {15, 0}, {15, 25}, {0, 25}};

inline TriangleMesh mesh_of(const shapes::Shape& shape) {
  return {shape.positions, shape.triangles};
}

inline TriangleMesh moved(TriangleMesh mesh, const Mat3& turn) {
  double low = 1e300;
  for (Vec3& p : mesh.positions) {
    p = turn * p;
    low = std::min(low, p.z());
  }
  for (Vec3& p : mesh.positions) p.z() -= low;
  return mesh;
}

// What a cup that leans keeps: water closes the inner rim at its highest point.
struct Kept {
  double closed_at_mm, area_mm2, volume_mm3;
};
inline Kept kept_by_leaning_cup(double tilt_deg) {
  const double depth = 25 - 15 * std::tan(tilt_deg * kRad);  // mean over the cup
  return {(15 + 18) * std::sin(tilt_deg * kRad), depth * polygon_outline(15) + polygon_area(15),
          depth * polygon_area(15)};
}

}  // namespace hydrodip::cups
