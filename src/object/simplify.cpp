#include "object/simplify.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

// Cells along the longest side: from so many, always fewer by that factor.
constexpr double kMostCells = 4096, kLeastCells = 8, kFewer = 1.25;
constexpr double kLeastCell_mm = 1e-12;

// Which vertices become one, on a grid.
struct Clusters {
  std::vector<std::int32_t> of;  // per vertex
  std::int32_t count = 0;
};

Clusters clusters(const Object& object, double cells_across) {
  const Box3 box = object.bounds();
  const double cell_mm = std::max(box.size().maxCoeff() / cells_across, kLeastCell_mm);
  Clusters result;
  result.of.reserve(object.positions.size());
  std::unordered_map<std::uint64_t, std::int32_t> known;
  known.reserve(object.positions.size() / 4);
  CheckEvery check(1 << 14);
  for (const Vec3& p : object.positions) {
    check();
    std::uint64_t cell = 0;
    for (int k = 0; k < 3; ++k) cell = (cell << 20U) | std::uint64_t((p[k] - box.min[k]) / cell_mm);
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

std::vector<Vec3> middles(const std::vector<Vec3>& positions, const Clusters& clusters) {
  std::vector<Vec3> sums(std::size_t(clusters.count), Vec3::Zero());
  std::vector<double> counts(sums.size(), 0);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    sums[std::size_t(clusters.of[v])] += positions[v];
    ++counts[std::size_t(clusters.of[v])];
  }
  for (std::size_t c = 0; c < sums.size(); ++c) sums[c] /= counts[c];
  return sums;
}

// What touched the box stays at it.
void keep_box(const Object& object, const Clusters& clusters, Object& coarse) {
  const Box3 box = object.bounds();
  for (std::size_t v = 0; v < object.positions.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      const double at = object.positions[v][k];
      if (at == box.min[k] || at == box.max[k])
        coarse.positions[std::size_t(clusters.of[v])][k] = at;
    }
}

Object joined(const Object& object, const Clusters& clusters) {
  Object result;
  result.materials = object.materials;
  result.textures = object.textures;
  result.positions = middles(object.positions, clusters);
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Triangle triangle = joined(object.triangles[t], clusters);
    if (!has_area(triangle)) continue;
    result.triangles.push_back(triangle);
    result.material_of.push_back(object.material_of[t]);
    if (!object.uvs.empty()) result.uvs.push_back(object.uvs[t]);
    if (!object.colors.empty()) result.colors.push_back(object.colors[t]);
  }
  return result;
}

}  // namespace

Object drawn_together(const Object& object, double cells_across) {
  return joined(object, clusters(object, cells_across));
}

Object simplified(const Object& object, std::size_t most_triangles) {
  if (object.triangles.size() <= most_triangles) return object;
  if (!(object.bounds().size().maxCoeff() > 0)) return object;
  Clusters joining;
  double cells = kMostCells;
  // A surface has about two triangles to each cell that it goes through.
  while (cells > 2 * kLeastCells && cells * cells > 4 * double(most_triangles)) cells /= kFewer;
  for (; cells >= kLeastCells; cells /= kFewer) {
    joining = clusters(object, cells);
    if (left_over(object.triangles, joining) <= most_triangles) break;
  }
  Object result = joined(object, joining);
  keep_box(object, joining, result);
  return result;
}

}  // namespace hydrodip
