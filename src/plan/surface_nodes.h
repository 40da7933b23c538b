// The object's surface as a cloud of points that know their neighbours: where seams are laid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plan/targets.h"

namespace hydrodip {

// Immutable once built; safe to query from many threads. Copies its targets.
class SurfaceNodes {
 public:
  explicit SurfaceNodes(Targets targets);

  const std::vector<Target>& nodes() const { return targets_.list; }
  const Targets& targets() const { return targets_; }
  // Distance of nodes, about: the side of the square that one stands for.
  double spacing() const { return spacing_; }

  // Whether surface looks the same way within 60 degrees or so.
  static bool face_alike(const Vec3& normal, const Vec3& other) { return normal.dot(other) > 0.5; }

  // Nodes within `reach` of a point, on surface that looks the same way within 60 degrees or so: a
  // thin wall has two sides. In ascending order.
  void near(const Vec3& position, const Vec3& normal, double reach,
            std::vector<std::int32_t>& found) const;

  // Pairs (a < b) of neighbours: nodes no further apart than 1.7 times the spacing.
  std::vector<std::array<std::int32_t, 2>> neighbors() const;

 private:
  using Cell = std::array<int, 3>;
  // A node where it is looked for.
  struct Placed {
    Vec3 position, normal;
    std::int32_t node;
    int x;  // of its cell
  };
  // Of a point; beyond the nodes' box the nearest within it.
  Cell cell_at(const Vec3& position) const;
  // Cells that differ in x alone are a row.
  std::size_t row_of(int y, int z) const {
    return std::size_t(z) * (std::size_t(last_[1]) + 1) + std::size_t(y);
  }

  Targets targets_;
  double spacing_ = 1, cell_ = 1;
  Vec3 corner_ = Vec3::Zero();
  Cell last_ = {0, 0, 0};
  std::vector<Placed> by_row_;           // and in a row by x
  std::vector<std::uint32_t> row_ends_;  // in by_row_
};

}  // namespace hydrodip
