// Which part of the object's surface bounds a pocket of air.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "air/section.h"

namespace hydrodip {

// Of one mesh, for several pockets.
class PocketSurface {
 public:
  explicit PocketSurface(const TriangleMesh& mesh);

  struct Part {
    std::vector<std::int32_t> triangles;
    double area_mm2 = 0;    // above the water's plane and below the limit
    double volume_mm3 = 0;  // above the plane, by the divergence theorem
    Vec3 top = Vec3::Zero();
  };
  // Pieces of surface above `water` that hang together count as one, and belong to the pocket if it
  // lies in front of most of their area. `holds`: whether a point off the surface is in the pocket,
  // asked `reach_mm` in front of it. `below`: only what lies under this plane too is counted as
  // area.
  Part part(
      const Plane& water, const std::optional<Plane>& below,
      const std::function<bool(const Vec3& point, const Vec3& from, const Vec3& normal)>& holds,
      double reach_mm) const;

  bool is_closed() const { return open_edges_.empty(); }
  // Both ends of every edge that has one triangle alone.
  const std::vector<std::array<std::int32_t, 2>>& open_edges() const { return open_edges_; }

 private:
  const TriangleMesh& mesh_;
  // Triangles that share an edge, and its ends.
  struct Shared {
    std::int32_t a, b;
    std::int32_t one, other;
  };
  std::vector<Shared> shared_;
  std::vector<std::array<std::int32_t, 2>> open_edges_;
};

}  // namespace hydrodip
