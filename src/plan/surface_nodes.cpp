#include "plan/surface_nodes.h"

#include <algorithm>
#include <cmath>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr double kSameSide = 0.5;       // cosine between normals
constexpr double kNeighborReach = 1.7;  // spacings
constexpr int kBits = 21;               // of a cell's coordinate

}  // namespace

SurfaceNodes::SurfaceNodes(Targets targets) : targets_(std::move(targets)) {
  Box3 box;
  for (const Target& node : targets_.list) box.add(node.position);
  if (targets_.list.empty()) return;
  corner_ = box.min;
  spacing_ = std::max(std::sqrt(targets_.area / double(targets_.list.size())), 1e-12);
  cell_ = std::max(2 * spacing_, box.size().maxCoeff() / double(1 << (kBits - 1)));
  CheckEvery check(1 << 12);
  for (std::size_t i = 0; i < targets_.list.size(); ++i) {
    check();
    in_cell_[cell_of(targets_.list[i].position)].push_back(std::int32_t(i));
  }
}

std::uint64_t SurfaceNodes::cell_of(const Vec3& position) const {
  const auto coordinate = [&](int axis) {
    const double at = std::floor((position[axis] - corner_[axis]) / cell_) + 1024;
    return std::uint64_t(std::clamp(at, 0.0, double((1 << kBits) - 1)));
  };
  return coordinate(0) | (coordinate(1) << kBits) | (coordinate(2) << (2 * kBits));
}

void SurfaceNodes::near(const Vec3& position, const Vec3& normal, double reach,
                        std::vector<std::int32_t>& found) const {
  found.clear();
  const int cells = int(std::ceil(reach / cell_));
  for (int z = -cells; z <= cells; ++z)
    for (int y = -cells; y <= cells; ++y)
      for (int x = -cells; x <= cells; ++x) {
        const auto at = in_cell_.find(cell_of(position + cell_ * Vec3(x, y, z)));
        if (at == in_cell_.end()) continue;
        for (const std::int32_t i : at->second) {
          const Target& node = targets_.list[std::size_t(i)];
          if ((node.position - position).squaredNorm() > reach * reach) continue;
          if (node.normal.dot(normal) > kSameSide) found.push_back(i);
        }
      }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

std::vector<std::array<std::int32_t, 2>> SurfaceNodes::neighbors() const {
  std::vector<std::array<std::int32_t, 2>> pairs;
  std::vector<std::int32_t> close;
  CheckEvery check(1 << 10);
  for (std::size_t i = 0; i < targets_.list.size(); ++i) {
    check();
    const Target& node = targets_.list[i];
    near(node.position, node.normal, kNeighborReach * spacing_, close);
    for (const std::int32_t j : close)
      if (j > std::int32_t(i)) pairs.push_back({std::int32_t(i), j});
  }
  return pairs;
}

}  // namespace hydrodip
