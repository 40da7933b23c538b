// The nearest of some nodes: however far away it is, few are looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/surface_nodes.h"

namespace hydrodip {

// Immutable; safe to ask from many threads.
class NearestNode {
 public:
  NearestNode() = default;  // of none
  // Among these nodes, by number.
  NearestNode(const SurfaceNodes& nodes, const std::vector<std::int32_t>& among);

  struct Found {
    std::int32_t node = -1;  // -1: none is within reach
    double squared = 0;      // its squared distance
    int looked_at = 0;       // nodes, for that
  };
  // The nearest of those that SurfaceNodes::near finds; of several the first.
  Found find(const Vec3& position, const Vec3& normal, double reach) const;

 private:
  // A k-d tree: the middle one of a range is where it is divided, at right angles to its axis.
  struct Placed {
    Vec3 position, normal;
    std::int32_t node;
    int axis;
  };
  struct Looking;
  void sort(std::size_t begin, std::size_t end);
  void look(std::size_t begin, std::size_t end, Looking& looking) const;

  std::vector<Placed> placed_;
};

}  // namespace hydrodip
