#include "plan/surface_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr double kNeighborReach = 1.7;  // spacings
constexpr int kMostCells = 1 << 20;     // along an axis
constexpr double kMostRows = 1 << 20;   // of cells

double rows_of(const Vec3& size, double cell) {
  return (size.y() / cell + 1) * (size.z() / cell + 1);
}

}  // namespace

SurfaceNodes::SurfaceNodes(Targets targets) : targets_(std::move(targets)) {
  Box3 box;
  for (const Target& node : targets_.list) box.add(node.position);
  if (targets_.list.empty()) return;
  corner_ = box.min;
  spacing_ = std::max(std::sqrt(targets_.area / double(targets_.list.size())), 1e-12);
  cell_ = std::max(2 * spacing_, box.size().maxCoeff() / kMostCells);
  while (rows_of(box.size(), cell_) > kMostRows) cell_ *= 2;
  last_ = {kMostCells, kMostCells, kMostCells};
  last_ = cell_at(box.max);
  std::vector<Cell> cells;
  CheckEvery check(1 << 12);
  for (const Target& node : targets_.list) {
    check();
    cells.push_back(cell_at(node.position));
  }
  std::vector<std::int32_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    const Cell &p = cells[std::size_t(a)], &q = cells[std::size_t(b)];
    return std::tie(p[2], p[1], p[0], a) < std::tie(q[2], q[1], q[0], b);
  });
  row_ends_.assign(row_of(last_[1], last_[2]) + 1, 0);
  for (const std::int32_t i : order) {
    check();
    const Cell& cell = cells[std::size_t(i)];
    const Target& node = targets_.list[std::size_t(i)];
    by_row_.push_back({node.position, node.normal, i, cell[0]});
    ++row_ends_[row_of(cell[1], cell[2])];
  }
  std::partial_sum(row_ends_.begin(), row_ends_.end(), row_ends_.begin());
}

SurfaceNodes::Cell SurfaceNodes::cell_at(const Vec3& position) const {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor((position[axis] - corner_[axis]) / cell_);
    cell[std::size_t(axis)] = int(std::clamp(at, 0.0, double(last_[std::size_t(axis)])));
  }
  return cell;
}

void SurfaceNodes::near(const Vec3& position, const Vec3& normal, double reach,
                        std::vector<std::int32_t>& found) const {
  found.clear();
  if (by_row_.empty()) return;
  // Only as far as there are nodes: the reach can be many times the object.
  const Cell low = cell_at(position - Vec3::Constant(reach));
  const Cell high = cell_at(position + Vec3::Constant(reach));
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y) {
      const std::size_t row = row_of(y, z);
      const auto end = by_row_.begin() + row_ends_[row];
      auto placed = std::lower_bound(by_row_.begin() + (row > 0 ? row_ends_[row - 1] : 0), end,
                                     low[0], [](const Placed& at, int x) { return at.x < x; });
      for (; placed != end && placed->x <= high[0]; ++placed)
        if (!((placed->position - position).squaredNorm() > reach * reach) &&
            face_alike(placed->normal, normal))
          found.push_back(placed->node);
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
