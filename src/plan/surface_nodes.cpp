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
  last_ = {1 << (kBits - 1), 1 << (kBits - 1), 1 << (kBits - 1)};
  last_ = cell_at(box.max);
  CheckEvery check(1 << 12);
  for (std::size_t i = 0; i < targets_.list.size(); ++i) {
    check();
    in_cell_[key_of(cell_at(targets_.list[i].position))].push_back(std::int32_t(i));
  }
}

SurfaceNodes::Cell SurfaceNodes::cell_at(const Vec3& position) const {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor((position[axis] - corner_[axis]) / cell_);
    cell[std::size_t(axis)] = int(std::clamp(at, 0.0, double(last_[std::size_t(axis)])));
  }
  return cell;
}

std::uint64_t SurfaceNodes::key_of(const Cell& cell) {
  return std::uint64_t(cell[0]) | (std::uint64_t(cell[1]) << kBits) |
         (std::uint64_t(cell[2]) << (2 * kBits));
}

bool SurfaceNodes::face_alike(const Vec3& normal, const Vec3& other) {
  return normal.dot(other) > kSameSide;
}

void SurfaceNodes::near(const Vec3& position, const Vec3& normal, double reach,
                        std::vector<std::int32_t>& found) const {
  found.clear();
  // Only as far as there are nodes: the reach can be many times the object.
  const Cell low = cell_at(position - Vec3::Constant(reach));
  const Cell high = cell_at(position + Vec3::Constant(reach));
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        const auto at = in_cell_.find(key_of({x, y, z}));
        if (at == in_cell_.end()) continue;
        for (const std::int32_t i : at->second) {
          const Target& node = targets_.list[std::size_t(i)];
          if ((node.position - position).squaredNorm() > reach * reach) continue;
          if (face_alike(node.normal, normal)) found.push_back(i);
        }
      }
  std::sort(found.begin(), found.end());
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
