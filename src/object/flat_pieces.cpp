#include "object/flat_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/run_scope.h"
#include "object/edges.h"

namespace hydrodip {
namespace {

const double kLeastCosine = std::cos(0.5 * std::numbers::pi / 180);

// Per triangle: those across its sides, -1 for none.
std::vector<std::array<std::int32_t, 3>> across_sides(const TriangleMesh& mesh) {
  std::vector<std::array<std::int32_t, 3>> across(mesh.triangles.size(), {-1, -1, -1});
  const auto join = [&](std::int32_t triangle, std::int32_t other) {
    auto& of = across[std::size_t(triangle)];
    if (const auto free = std::find(of.begin(), of.end(), -1); free != of.end()) *free = other;
  };
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    join(face_of(sides[begin]), face_of(sides[begin + 1]));
    join(face_of(sides[begin + 1]), face_of(sides[begin]));
  });
  return across;
}

}  // namespace

std::vector<std::vector<std::size_t>> flat_pieces(const TriangleMesh& mesh) {
  const auto across = across_sides(mesh);
  std::vector<Vec3> normal(mesh.triangles.size());
  std::vector<double> area(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    const Vec3& a = mesh.positions[std::size_t(v[0])];
    normal[t] =
        (mesh.positions[std::size_t(v[1])] - a).cross(mesh.positions[std::size_t(v[2])] - a);
    area[t] = normal[t].norm();
    if (area[t] > 0) normal[t] /= area[t];
  }
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return area[a] > area[b]; });
  std::vector<std::uint8_t> taken(mesh.triangles.size(), 0);
  std::vector<std::vector<std::size_t>> pieces;
  CheckEvery check(1 << 12);
  for (const std::size_t seed : order) {
    check();
    if (taken[seed]) continue;
    taken[seed] = 1;
    std::vector<std::size_t> piece = {seed};
    for (std::size_t i = 0; i < piece.size(); ++i)
      for (const std::int32_t other : across[piece[i]]) {
        if (other < 0 || taken[std::size_t(other)]) continue;
        if (!(normal[std::size_t(other)].dot(normal[seed]) > kLeastCosine)) continue;
        taken[std::size_t(other)] = 1;
        piece.push_back(std::size_t(other));
      }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace hydrodip
