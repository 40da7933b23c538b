// Surfaces with closed forms, and pictures to put on them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>

#include "object/posed_object.h"

namespace hydrodip {

inline constexpr double kPi = std::numbers::pi;

inline Object with_materials(TriangleMesh mesh) {
  Object object;
  static_cast<TriangleMesh&>(object) = std::move(mesh);
  object.materials.resize(1);
  object.material_of.assign(object.triangles.size(), 0);
  return object;
}

// A sheet of n x m cells over [0, 1]^2, bent by `at`.
inline TriangleMesh sheet(int n, int m, const std::function<Vec3(double, double)>& at) {
  TriangleMesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.push_back(at(double(i) / n, double(j) / m));
  const auto v = [&](int i, int j) { return std::int32_t(j * (n + 1) + i); };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({v(i, j), v(i + 1, j), v(i + 1, j + 1)});
      mesh.triangles.push_back({v(i, j), v(i + 1, j + 1), v(i, j + 1)});
    }
  return mesh;
}

// Appends, sharing nothing.
inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto first = std::int32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (Triangle t : more.triangles) {
    for (std::int32_t& v : t) v += first;
    mesh.triangles.push_back(t);
  }
}

// Outward, from `low` to `high`.
inline TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                                k & 4 ? high.z() : low.z());
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

// Equal corners become one, and what has no area goes.
inline TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  std::map<std::array<long, 3>, std::int32_t> known;
  std::vector<std::int32_t> now;
  for (const Vec3& p : mesh.positions) {
    const std::array<long, 3> key = {std::lround(p.x() * 1e6), std::lround(p.y() * 1e6),
                                     std::lround(p.z() * 1e6)};
    const auto [found, is_new] = known.try_emplace(key, std::int32_t(result.positions.size()));
    if (is_new) result.positions.push_back(p);
    now.push_back(found->second);
  }
  for (const Triangle& t : mesh.triangles) {
    const Triangle v = {now[std::size_t(t[0])], now[std::size_t(t[1])], now[std::size_t(t[2])]};
    if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) result.triangles.push_back(v);
  }
  return result;
}

// Around z, outward, without caps.
inline TriangleMesh tube(double radius, double height, int around, int along) {
  return welded(sheet(around, along, [=](double s, double t) {
    return Vec3(radius * std::cos(2 * kPi * s), radius * std::sin(2 * kPi * s), height * t);
  }));
}

// Latitude and longitude, outward.
inline TriangleMesh ball(double radius, int around, int along) {
  return welded(sheet(around, along, [=](double s, double t) {
    const double latitude = kPi * (t - 0.5);
    return Vec3(radius * Vec3(std::cos(latitude) * std::cos(2 * kPi * s),
                              std::cos(latitude) * std::sin(2 * kPi * s), std::sin(latitude)));
  }));
}

// As it stands: positions are the model's, but for the shift that centres it over the bath.
inline PosedObject posed(const TriangleMesh& mesh, const PoseOptions& pose = {}) {
  return PosedObject(std::make_shared<const Object>(with_materials(mesh)), pose);
}

// From the model's frame to the posed one, of an object that is not turned.
inline Vec3 moved(const PosedObject& object, const Vec3& p) {
  return object.matrix().topLeftCorner<3, 3>() * p + object.matrix().topRightCorner<3, 1>();
}

inline void each_point(const TriangleMesh& mesh,
                       const std::function<void(const SurfacePoint&)>& see) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const double u : {0.1, 0.3, 0.6})
      for (const double v : {0.05, 0.25}) see({int(t), u, v});
}

inline std::shared_ptr<const Image> painted(int width, int height,
                                            const std::function<std::array<int, 4>(int, int)>& at) {
  auto image = std::make_shared<Image>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 4; ++c) image->pixel(x, y)[c] = std::uint8_t(at(x, y)[c]);
  return image;
}

}  // namespace hydrodip
