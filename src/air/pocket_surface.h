// Which part of the object's surface bounds a pocket of air.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "air/section.h"

namespace hydrodip {

// Of one mesh, for several pockets.
class PocketSurface {
 public:
  explicit PocketSurface(const TriangleMesh& mesh);

  struct Part {
    std::vector<std::int32_t> triangles;
    double area_mm2 = 0;    // above the water's plane, and below one of `levels`
    double volume_mm3 = 0;  // above the plane, by the divergence theorem
    Vec3 top = Vec3::Zero();
    bool is_whole = true;  // no piece of it was divided: its volume is right
  };
  // Whether a point off the surface, in front of `from`, is in the pocket.
  using Holds = std::function<bool(const Vec3& point, const Vec3& from, const Vec3& normal)>;
  // Pieces of surface above `water` that hang together count as one: they belong to the pocket if
  // it lies in front of nearly all of their area, asked `reach_mm` in front of it. Where it lies in
  // front of a part of one, as of bodies that reach into each other, what no crease divides counts
  // as one, and then every triangle for itself. Of what belongs, only what lies under one of
  // `levels` is counted as area.
  Part part(const Plane& water, const std::vector<Plane>& levels, const Holds& holds,
            double reach_mm) const;

  bool is_closed() const { return open_edges_.empty(); }
  // Both ends of every edge that has one triangle alone.
  const std::vector<std::array<std::int32_t, 2>>& open_edges() const { return open_edges_; }

 private:
  // Of a triangle: how much lies above the water, and how much of that in front of the pocket.
  struct Share {
    double above_mm2 = 0, in_pocket_mm2 = 0;
  };
  std::vector<Share> shares(const Plane& water, const Holds& holds, double reach_mm) const;
  // Per triangle, whether it belongs to the pocket; `is_whole`: as Part has it.
  std::vector<bool> belonging(const Plane& water, const std::vector<Share>& shares,
                              bool& is_whole) const;
  std::vector<Vec3> above(std::size_t triangle, const Plane& water) const;

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
