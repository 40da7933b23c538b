#include "object/flat_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

const double kLeastCosine = std::cos(0.5 * std::numbers::pi / 180);

struct Side {
  std::int32_t from, to;  // ascending
  std::int32_t triangle;
};

// Per triangle: those across its sides, -1 for none.
std::vector<std::array<std::int32_t, 3>> across_sides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [from, to] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      sides.push_back({from, to, std::int32_t(t)});
    }
  const auto before = [](const Side& a, const Side& b) {
    return std::array{a.from, a.to, a.triangle} < std::array{b.from, b.to, b.triangle};
  };
  sort_unless_cancelled(sides.begin(), sides.end(), before);
  std::vector<std::array<std::int32_t, 3>> across(mesh.triangles.size(), {-1, -1, -1});
  const auto join = [&](std::int32_t triangle, std::int32_t other) {
    auto& of = across[std::size_t(triangle)];
    if (const auto free = std::find(of.begin(), of.end(), -1); free != of.end()) *free = other;
  };
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].from == sides[i].from && sides[end].to == sides[i].to)
      ++end;
    if (end - i == 2) {
      join(sides[i].triangle, sides[i + 1].triangle);
      join(sides[i + 1].triangle, sides[i].triangle);
    }
    i = end;
  }
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
