#include "object/simplify.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

// Cells along the longest side: from so many, always fewer by that factor.
constexpr double kMostCells = 4096, kLeastCells = 8, kFewer = 1.25;

// Which vertices become one, on a grid.
struct Clusters {
  std::vector<std::int32_t> of;  // per vertex
  std::int32_t count = 0;
};

Clusters clusters(const std::vector<Vec3>& positions, const Vec3& corner, double cell_mm) {
  Clusters result;
  result.of.reserve(positions.size());
  std::unordered_map<std::uint64_t, std::int32_t> known;
  known.reserve(positions.size() / 4);
  for (const Vec3& p : positions) {
    std::uint64_t cell = 0;
    for (int k = 0; k < 3; ++k) cell = (cell << 20U) | std::uint64_t((p[k] - corner[k]) / cell_mm);
    const auto [at, is_new] = known.try_emplace(cell, result.count);
    result.count += is_new;
    result.of.push_back(at->second);
  }
  return result;
}

Triangle joined(const Triangle& t, const Clusters& clusters) {
  return {clusters.of[std::size_t(t[0])], clusters.of[std::size_t(t[1])],
          clusters.of[std::size_t(t[2])]};
}

bool has_area(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

std::size_t left_over(const std::vector<Triangle>& triangles, const Clusters& clusters) {
  return std::size_t(std::count_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return has_area(joined(t, clusters));
  }));
}

// In the middle of what became one; what touches the box stays at it.
std::vector<Vec3> middles(const std::vector<Vec3>& positions, const Clusters& clusters,
                          const Box3& box) {
  std::vector<Vec3> sums(std::size_t(clusters.count), Vec3::Zero());
  std::vector<double> counts(sums.size(), 0);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    sums[std::size_t(clusters.of[v])] += positions[v];
    ++counts[std::size_t(clusters.of[v])];
  }
  for (std::size_t c = 0; c < sums.size(); ++c) sums[c] /= counts[c];
  for (std::size_t v = 0; v < positions.size(); ++v)
    for (int k = 0; k < 3; ++k)
      if (positions[v][k] == box.min[k] || positions[v][k] == box.max[k])
        sums[std::size_t(clusters.of[v])][k] = positions[v][k];
  return sums;
}

}  // namespace

Object simplified(const Object& object, std::size_t most_triangles) {
  if (object.triangles.size() <= most_triangles) return object;
  const Box3 box = object.bounds();
  const double extent = box.size().maxCoeff();
  if (!(extent > 0)) return object;
  Clusters joining;
  double cells = kMostCells;
  // A surface has about two triangles to each cell that it goes through.
  while (cells > 2 * kLeastCells && cells * cells > 4 * double(most_triangles)) cells /= kFewer;
  for (; cells >= kLeastCells; cells /= kFewer) {
    check_cancelled();
    joining = clusters(object.positions, box.min, extent / cells);
    if (left_over(object.triangles, joining) <= most_triangles) break;
  }
  Object result;
  result.materials = object.materials;
  result.textures = object.textures;
  result.positions = middles(object.positions, joining, box);
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Triangle triangle = joined(object.triangles[t], joining);
    if (!has_area(triangle)) continue;
    result.triangles.push_back(triangle);
    result.material_of.push_back(object.material_of[t]);
    if (!object.uvs.empty()) result.uvs.push_back(object.uvs[t]);
    if (!object.colors.empty()) result.colors.push_back(object.colors[t]);
  }
  return result;
}

}  // namespace hydrodip
