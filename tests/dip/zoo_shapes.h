// A zoo of shapes that a dip must survive, in the posed-object frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "exact/shapes.h"
#include "film/film.h"

namespace hydrodip::shapes {

// Coarse, and large enough for all of them.
inline FilmOptions zoo_film() {
  FilmOptions options;
  options.width_mm = 160;
  options.height_mm = 150;
  options.elements = 3000;
  return options;
}

inline Shape placed(Shape shape, const Vec3& turn_deg = Vec3::Zero(),
                    const Vec2& center = Vec2::Zero()) {
  const double k = M_PI / 180;
  for (Vec3& p : shape.positions) {
    const auto turn = [&](Eigen::Index a, Eigen::Index b, double angle) {
      const double x = p[a], y = p[b];
      p[a] = std::cos(angle) * x - std::sin(angle) * y;
      p[b] = std::sin(angle) * x + std::cos(angle) * y;
    };
    turn(1, 2, turn_deg.x() * k);
    turn(2, 0, turn_deg.y() * k);
    turn(0, 1, turn_deg.z() * k);
  }
  Box3 box;
  for (const Vec3& p : shape.positions) box.add(p);
  const Vec3 shift(center.x() - box.center().x(), center.y() - box.center().y(), -box.min.z());
  for (Vec3& p : shape.positions) p += shift;
  return shape;
}

// Meridian through the given corners, from the bottom up.
inline Shape turned(const std::vector<Vec2>& corners, int segments = 160) {
  return revolve(
      [&](double s) {
        const double at = s * double(corners.size() - 1);
        const auto i = std::min(corners.size() - 2, std::size_t(at + 1e-9));
        return Vec2(corners[i] + (at - double(i)) * (corners[i + 1] - corners[i]));
      },
      int(corners.size()) - 1, segments);
}

inline Shape torus(double ring_radius, double tube_radius, int rings = 160, int segments = 64) {
  Shape shape;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const double a = 2 * M_PI * i / rings, b = 2 * M_PI * j / segments;
      const double r = ring_radius + tube_radius * std::cos(b);
      shape.add(r * std::cos(a), r * std::sin(a), tube_radius * (1 + std::sin(b)));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const int k = (i + 1) % rings, l = (j + 1) % segments;
      const std::int32_t p = i * segments + j, q = k * segments + j, r = k * segments + l,
                         s = i * segments + l;
      shape.triangles.push_back({p, q, r});
      shape.triangles.push_back({p, r, s});
    }
  return shape;
}

inline Shape comb(double pitch_mm = 4, double fin_mm = 1, int fins = 9) {
  Shape shape;
  const double width = pitch_mm * (fins - 1) + fin_mm;
  for (int i = 0; i < fins; ++i) {
    const double x = -width / 2 + i * pitch_mm;
    shape.append(box({x, -20, 0}, {x + fin_mm, 20, 15}));
  }
  shape.append(box({-width / 2, -20, 14}, {width / 2, 20, 20}));
  return shape;
}

inline Shape two_parts() {
  Shape shape = placed(full_sphere(14, 60, 80), Vec3::Zero(), {-22, 0});
  Shape other = placed(turned({{0, 0}, {12, 12}, {12, 30}, {0, 30}}, 80), Vec3::Zero(), {22, 5});
  for (Vec3& p : other.positions) p.z() += 6;
  shape.append(other);
  return shape;
}

// Hemisphere shell, 3 mm thick, its opening facing down.
inline Shape cup(double radius = 25) {
  std::vector<Vec2> corners;
  for (int i = 0; i <= 40; ++i)  // inside, from the top down to the edge
    corners.push_back(
        {(radius - 3) * std::sin(M_PI / 2 * i / 40), (radius - 3) * std::cos(M_PI / 2 * i / 40)});
  for (int i = 40; i >= 0; --i)
    corners.push_back({radius * std::sin(M_PI / 2 * i / 40), radius * std::cos(M_PI / 2 * i / 40)});
  return turned(corners);
}

// What a scanner leaves: holes, turned and doubled faces, slivers, noise, parts that cross.
inline Shape scan_like() {
  Shape shape = placed(full_sphere(22, 60, 90));
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (Vec3& p : shape.positions)
    p += 0.15 * Vec3(unit(generator), unit(generator), unit(generator));
  std::vector<Triangle> kept;
  for (Triangle t : shape.triangles) {
    const double dice = unit(generator);
    if (dice < 0.02) continue;
    if (dice < 0.05) std::swap(t[0], t[1]);
    kept.push_back(t);
    if (dice > 0.97) kept.push_back(t);
    if (dice > 0.95) kept.push_back({t[0], t[0], t[1]});
    if (dice > 0.93) kept.push_back({t[0], t[1], t[1]});
  }
  shape.triangles = kept;
  shape.append(placed(box({-6, -6, 0}, {30, 6, 9}), {10, 20, 30}, {8, 4}));
  return placed(shape);
}

struct Named {
  std::string name;
  Shape shape;
};

inline std::vector<Named> zoo() {
  const Shape cube = box({-15, -15, 0}, {15, 15, 30});
  return {
      {"cylinder", turned({{0, 0}, {20, 0}, {20, 30}, {0, 30}})},
      {"cube on a face", cube},
      {"cube on an edge", placed(cube, {45, 0, 10})},
      {"cube on a corner", placed(cube, {45, std::atan(1 / std::sqrt(2.0)) * 180 / M_PI, 0})},
      {"full sphere", full_sphere(22)},
      {"torus lying flat", torus(22, 9)},
      {"mushroom", turned({{0, 0}, {7, 0}, {7, 20}, {25, 22}, {25, 27}, {0, 40}})},
      {"comb of 1 mm fins", comb()},
      {"needle", turned({{0, 0}, {0.4, 2}, {0.6, 40}, {0, 40}}, 24)},
      {"two parts", two_parts()},
      {"cup opening down", cup()},
      {"scan", scan_like()},
  };
}

}  // namespace hydrodip::shapes
