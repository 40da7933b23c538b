#include "object/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/run_scope.h"

namespace hydrodip {

namespace {

std::uint64_t hash_position(const Vec3& p) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  for (int i = 0; i < 3; ++i) {
    const double coordinate = p[i] + 0.0;  // -0 equals 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &coordinate, sizeof bits);
    hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
    hash ^= hash >> 32;
  }
  return hash;
}

// Of a surface's rims, where each is told from its neighbours: cells of the size of what
// coordinates of seven digits leave open, in order.
struct RimCell {
  std::array<std::int64_t, 3> cell;
  std::int32_t vertex;
  bool operator<(const RimCell& other) const {
    return std::tie(cell, vertex) < std::tie(other.cell, other.vertex);
  }
};

}  // namespace

void weld(Object& object) {
  std::size_t slots = 16;
  while (slots < 2 * object.positions.size()) slots *= 2;
  std::vector<std::int32_t> table(slots, -1);
  std::vector<std::int32_t> renamed(object.positions.size(), -1);
  std::vector<Vec3> kept;
  auto rename = [&](std::int32_t old) {
    std::int32_t& name = renamed[std::size_t(old)];
    if (name >= 0) return name;
    const Vec3& p = object.positions[std::size_t(old)];
    std::size_t slot = hash_position(p) & (slots - 1);
    while (table[slot] >= 0 && kept[std::size_t(table[slot])] != p) slot = (slot + 1) & (slots - 1);
    if (table[slot] < 0) {
      table[slot] = std::int32_t(kept.size());
      kept.push_back(p);
    }
    return name = table[slot];
  };
  CheckEvery check(kTrianglesBetweenChecks);
  for (Triangle& triangle : object.triangles) {
    check();
    for (std::int32_t& vertex : triangle) vertex = rename(vertex);
  }
  object.positions = std::move(kept);
}

std::vector<std::int32_t> rim_vertices(const std::vector<TriangleSide>& sides) {
  std::vector<std::int32_t> rim;
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 1) return;
    rim.push_back(sides[begin].low_vertex());
    rim.push_back(sides[begin].high_vertex());
  });
  sort_unless_cancelled(rim.begin(), rim.end(), std::less<>());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  return rim;
}

// sine of a whole turn). True if there were any.
bool close_seams(Object& object, const std::vector<TriangleSide>& sides) {
  constexpr double kRoundings = 4, kMostOfSize = 1e-6;
  const std::vector<std::int32_t> rim = rim_vertices(sides);
  const Box3 box = object.bounds();
  const double apart = std::min(kMostOfSize * box.size().norm(),
                                kRoundings * double(std::numeric_limits<float>::epsilon()) *
                                    box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff());
  if (rim.empty() || !(apart > 0)) return false;
  std::vector<RimCell> cells;
  cells.reserve(rim.size());
  for (const std::int32_t v : rim) {
    const Vec3 at = object.positions[std::size_t(v)] / apart;
    cells.push_back({{std::int64_t(std::floor(at.x())), std::int64_t(std::floor(at.y())),
                      std::int64_t(std::floor(at.z()))},
                     v});
  }
  sort_unless_cancelled(cells.begin(), cells.end(), std::less<>());
  DisjointSets same(object.positions.size());
  bool any = false;
  CheckEvery check(kTrianglesBetweenChecks);
  for (const RimCell& one : cells) {
    check();
    const Vec3& p = object.positions[std::size_t(one.vertex)];
    for (int around = 0; around < 9; ++around) {
      // Three cells along z lie one after another.
      const std::array<std::int64_t, 3> from = {one.cell[0] + around % 3 - 1,
                                                one.cell[1] + around / 3 - 1, one.cell[2] - 1};
      auto at = std::lower_bound(cells.begin(), cells.end(), RimCell{from, 0});
      for (; at != cells.end() && at->cell[0] == from[0] && at->cell[1] == from[1] &&
             at->cell[2] <= from[2] + 2;
           ++at) {
        if (at->vertex <= one.vertex ||
            (object.positions[std::size_t(at->vertex)] - p).norm() > apart)
          continue;
        same.join(one.vertex, at->vertex);
        any = true;
      }
    }
  }
  if (!any) return false;
  for (Triangle& triangle : object.triangles)
    for (std::int32_t& v : triangle) v = std::int32_t(same.find(std::uint32_t(v)));
  return true;
}

}  // namespace hydrodip
