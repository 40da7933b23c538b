#include "render/normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "base/parallel.h"

namespace hydrodip {
namespace {

// More faces than this around one point (the hub of a fan) are not smoothed: the cost is quadratic.
constexpr std::size_t kMostFacesAround = 256;

bool less_position(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// For every vertex the number of its position, so that seams do not split the surface.
std::vector<int> weld(const std::vector<Vec3>& positions, int& count) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  sort_unless_cancelled(order.begin(), order.end(), [&](int a, int b) {
    const Vec3& pa = positions[std::size_t(a)];
    const Vec3& pb = positions[std::size_t(b)];
    return pa == pb ? a < b : less_position(pa, pb);
  });
  std::vector<int> welded(positions.size());
  count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same =
        i > 0 && positions[std::size_t(order[i])] == positions[std::size_t(order[i - 1])];
    if (!same) ++count;
    welded[std::size_t(order[i])] = count - 1;
  }
  return welded;
}

struct Corner {
  std::size_t triangle;
  std::size_t corner;
};

// Of every position, one after another.
struct CornersAround {
  std::vector<std::size_t> begin;  // and the end of the last
  std::vector<Corner> corners;

  std::span<const Corner> of(std::size_t position) const {
    return std::span(corners).subspan(begin[position], begin[position + 1] - begin[position]);
  }
};

CornersAround corners_around(const std::vector<Triangle>& triangles, const std::vector<int>& welded,
                             int count) {
  CornersAround around{std::vector<std::size_t>(std::size_t(count) + 1),
                       std::vector<Corner>(3 * triangles.size())};
  const auto every_corner = [&](const auto& visit) {
    CheckEvery check(1 << 14);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      check();
      for (std::size_t k = 0; k < 3; ++k)
        visit(std::size_t(welded[std::size_t(triangles[t][k])]), Corner{t, k});
    }
  };
  every_corner([&](std::size_t position, const Corner&) { ++around.begin[position + 1]; });
  std::partial_sum(around.begin.begin(), around.begin.end(), around.begin.begin());
  std::vector<std::size_t> next(around.begin.begin(), around.begin.end() - 1);
  every_corner([&](std::size_t position, const Corner& corner) {
    around.corners[next[position]++] = corner;
  });
  return around;
}

double corner_angle(const std::vector<Vec3>& positions, const Triangle& triangle, std::size_t k) {
  const Vec3& p = positions[std::size_t(triangle[k])];
  const Vec3 a = positions[std::size_t(triangle[(k + 1) % 3])] - p;
  const Vec3 b = positions[std::size_t(triangle[(k + 2) % 3])] - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::vector<std::array<double, 3>> corner_angles(const std::vector<Vec3>& positions,
                                                 const std::vector<Triangle>& triangles) {
  std::vector<std::array<double, 3>> angles(triangles.size());
  parallel_for(triangles.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t k = 0; k < 3; ++k) angles[t][k] = corner_angle(positions, triangles[t], k);
  });
  return angles;
}

std::vector<Vec3> face_normals(const std::vector<Vec3>& positions,
                               const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3& a = positions[std::size_t(triangles[t][0])];
    const Vec3 n = (positions[std::size_t(triangles[t][1])] - a)
                       .cross(positions[std::size_t(triangles[t][2])] - a);
    const double length = n.norm();
    normals[t] = length > 0 && std::isfinite(length) ? Vec3(n / length) : Vec3::Zero();
  }
  return normals;
}

}  // namespace

std::vector<CornerNormals> corner_normals(const std::vector<Vec3>& positions,
                                          const std::vector<Triangle>& triangles,
                                          double crease_deg) {
  int count = 0;
  const std::vector<int> welded = weld(positions, count);
  const CornersAround around = corners_around(triangles, welded, count);
  const std::vector<Vec3> flat = face_normals(positions, triangles);
  const std::vector<std::array<double, 3>> angles = corner_angles(positions, triangles);
  const double crease_cosine = std::cos(crease_deg * std::numbers::pi / 180);

  std::vector<CornerNormals> result(triangles.size());
  const auto smooth = [&](std::span<const Corner> fan, const Corner& self) {
    const Vec3& own = flat[self.triangle];
    Vec3 sum = Vec3::Zero();
    if (fan.size() <= kMostFacesAround) {
      for (const Corner& other : fan) {
        const Vec3& normal = flat[other.triangle];
        if (own.dot(normal) < crease_cosine) continue;
        sum += angles[other.triangle][other.corner] * normal;
      }
    }
    if (sum.norm() < 1e-9) sum = own;
    if (sum.norm() < 1e-9) sum = Vec3::UnitZ();
    result[self.triangle][self.corner] = sum.normalized();
  };
  parallel_for(std::size_t(count), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (const Corner& self : around.of(n)) smooth(around.of(n), self);
  });
  return result;
}

Vec3 normal_between(const CornerNormals& corners, double u, double v) {
  const Vec3 n = (1 - u - v) * corners[0] + u * corners[1] + v * corners[2];
  const double length = n.norm();
  return length < 1e-6 ? Vec3(Vec3::Zero()) : Vec3(n / length);
}

}  // namespace hydrodip
