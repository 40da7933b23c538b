// The calibration shapes: sphere, pyramid, ellipsoid, box.
#include <cmath>
#include <map>

#include "samples/painting.h"
#include "samples/parts.h"

namespace hydrodip {
namespace {

constexpr double kTexturePxPerMm = 16;
constexpr double kSquareMm = 5;
constexpr double kSphereRadiusMm = 30;
const Vec3 kEllipsoidSemiAxesMm(45, 30, 24);
constexpr double kPyramidBaseMm = 60;
constexpr double kPyramidHeightMm = 24;  // slope 38.7 degrees
constexpr double kBoxSideMm = 40;
constexpr double kBoxHeightMm = 15;

// The unit sphere as a subdivided octahedron: symmetric under quarter turns and reflections, with a
// vertex exactly at each pole.
Object unit_sphere(int divisions) {
  Object object;
  std::map<std::array<int, 3>, int> index_of;  // by integer position on the octahedron
  const auto vertex = [&](const std::array<int, 3>& cell) {
    const auto [it, is_new] = index_of.try_emplace(cell, int(object.positions.size()));
    if (is_new) object.positions.push_back(Vec3(cell[0], cell[1], cell[2]).normalized());
    return it->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
      const auto at = [&](const std::array<int, 2>& ij) {
        return vertex({sx * ij[0], sy * ij[1], sz * (divisions - ij[0] - ij[1])});
      };
      if (sx * sy * sz > 0)
        object.triangles.push_back({at(a), at(b), at(c)});
      else
        object.triangles.push_back({at(a), at(c), at(b)});
    };
    for (int i = 0; i < divisions; ++i)
      for (int j = 0; i + j < divisions; ++j) {
        add({i, j}, {i + 1, j}, {i, j + 1});
        if (i + j + 1 < divisions) add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
      }
  }
  return object;
}

Object ellipsoid_with_checkerboard(const Vec3& semi_axes_mm, int divisions,
                                   const std::string& name) {
  Object object = unit_sphere(divisions);
  for (Vec3& p : object.positions) p = p.cwiseProduct(semi_axes_mm).eval();
  const double size_mm = 2 * semi_axes_mm.head<2>().maxCoeff();
  set_planar_uvs(object, size_mm, size_mm);
  set_texture(object, name, checkerboard(size_mm));
  rest_on_zero(object);
  return object;
}

void add_quad(Object& object, int a, int b, int c, int d) {
  object.triangles.push_back({a, b, c});
  object.triangles.push_back({a, c, d});
}

}  // namespace

Image checkerboard(double size_mm) {
  Canvas canvas(size_mm, size_mm, kTexturePxPerMm);
  const LinearColor light = rgb(0xfbf6e9);
  const LinearColor dark[4] = {rgb(0x14315c), rgb(0xb3182d), rgb(0x11695a), rgb(0x6b2a7d)};
  canvas.fill_all([&](const Vec2&) { return light; });
  const int reach = int(std::ceil(size_mm / 2 / kSquareMm));
  for (int i = -reach; i < reach; ++i)
    for (int j = -reach; j < reach; ++j) {
      if ((i + j) % 2 != 0) continue;
      const double x0 = i * kSquareMm, y0 = j * kSquareMm;
      const double x1 = x0 + kSquareMm, y1 = y0 + kSquareMm;
      const LinearColor& color = dark[(i < 0 ? 1 : 0) + (j < 0 ? 2 : 0)];
      canvas.fill({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, color);
    }
  // An F in the light square at (7.5, 2.5).
  const LinearColor ink = dark[0];
  canvas.stroke({{6.6, 1.0}, {6.6, 4.0}}, 0.5, ink);
  canvas.stroke({{6.6, 4.0}, {8.6, 4.0}}, 0.5, ink);
  canvas.stroke({{6.6, 2.6}, {8.0, 2.6}}, 0.5, ink);
  return canvas.image();
}

Object make_sphere() {
  return ellipsoid_with_checkerboard(Vec3::Constant(kSphereRadiusMm), 100, "sphere");
}

Object make_ellipsoid() {
  return ellipsoid_with_checkerboard(kEllipsoidSemiAxesMm, 100, "ellipsoid");
}

Object make_pyramid() {
  const double h = kPyramidBaseMm / 2;
  Object object;
  object.positions = {posed(-h, -h, 0), posed(h, -h, 0), posed(h, h, 0), posed(-h, h, 0),
                      posed(0, 0, kPyramidHeightMm)};
  for (int i = 0; i < 4; ++i) object.triangles.push_back({i, (i + 1) % 4, 4});
  add_quad(object, 0, 3, 2, 1);
  set_planar_uvs(object, kPyramidBaseMm, kPyramidBaseMm);
  set_texture(object, "pyramid", checkerboard(kPyramidBaseMm));
  rest_on_zero(object);
  return object;
}

// Its texture is the box unfolded around its bottom: 15 + 40 + 15 mm each way. The top, which no
// film reaches, repeats the bottom.
Object make_box() {
  const double h = kBoxSideMm / 2;
  const double sheet_mm = kBoxSideMm + 2 * kBoxHeightMm;
  Object object;
  for (const double height : {kBoxHeightMm, 0.0}) {  // 0..3 printed side, 4..7 the side above it
    object.positions.push_back(posed(-h, -h, height));
    object.positions.push_back(posed(h, -h, height));
    object.positions.push_back(posed(h, h, height));
    object.positions.push_back(posed(-h, h, height));
  }
  const auto add_face = [&](const std::array<int, 4>& corner, const std::array<Vec2, 4>& unfolded) {
    const auto uv = [&](std::size_t i) {
      return Eigen::Vector2f((unfolded[i] / sheet_mm + Vec2::Constant(0.5)).cast<float>());
    };
    add_quad(object, corner[0], corner[1], corner[2], corner[3]);
    object.uvs.push_back({uv(0), uv(1), uv(2)});
    object.uvs.push_back({uv(0), uv(2), uv(3)});
  };
  const std::array<Vec2, 4> square = {Vec2(-h, -h), Vec2(h, -h), Vec2(h, h), Vec2(-h, h)};
  const std::array<Vec2, 4> outward = {Vec2(0, -1), Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0)};
  add_face({0, 1, 2, 3}, square);
  for (int side = 0; side < 4; ++side) {
    const int next = (side + 1) % 4;
    const auto a = std::size_t(side), b = std::size_t(next);
    const Vec2 away = kBoxHeightMm * outward[a];
    add_face({next, side, side + 4, next + 4},
             {square[b], square[a], Vec2(square[a] + away), Vec2(square[b] + away)});
  }
  add_face({4, 7, 6, 5}, {square[0], square[3], square[2], square[1]});
  set_texture(object, "box", checkerboard(sheet_mm));
  rest_on_zero(object);
  return object;
}

}  // namespace hydrodip
