// The object's surface as a cloud of points that know their neighbours: where seams are laid.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
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
  static bool face_alike(const Vec3& normal, const Vec3& other);

  // Nodes within `reach` of a point, on surface that looks the same way within 60 degrees or so: a
  // thin wall has two sides. In ascending order.
  void near(const Vec3& position, const Vec3& normal, double reach,
            std::vector<std::int32_t>& found) const;

  // Pairs (a < b) of neighbours: nodes no further apart than 1.7 times the spacing.
  std::vector<std::array<std::int32_t, 2>> neighbors() const;

 private:
  using Cell = std::array<int, 3>;
  // Of a point; beyond the nodes' box the nearest within it.
  Cell cell_at(const Vec3& position) const;
  static std::uint64_t key_of(const Cell& cell);

  Targets targets_;
  double spacing_ = 1, cell_ = 1;
  Vec3 corner_ = Vec3::Zero();
  Cell last_ = {0, 0, 0};
  std::unordered_map<std::uint64_t, std::vector<std::int32_t>> in_cell_;
};

}  // namespace hydrodip
