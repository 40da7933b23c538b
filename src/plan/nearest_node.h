// The nearest of some nodes: however far away it is, few are looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/surface_nodes.h"

namespace hydrodip {

// Immutable; safe to ask from many threads. Refers to the nodes.
class NearestNode {
 public:
  // Among these nodes, by number.
  NearestNode(const SurfaceNodes& nodes, std::vector<std::int32_t> among);

  // Squared distance to the nearest of those that SurfaceNodes::near finds; infinity: none is
  // within `reach`.
  double squared_distance(const Vec3& position, const Vec3& normal, double reach) const;

 private:
  struct Looking;
  void sort(std::size_t begin, std::size_t end);
  void look(std::size_t begin, std::size_t end, Looking& looking) const;

  const std::vector<Target>& nodes_;
  // A k-d tree: the middle one of a range is where it is divided, at right angles to its axis.
  std::vector<std::int32_t> sorted_;
  std::vector<std::uint8_t> axis_;
};

}  // namespace hydrodip
