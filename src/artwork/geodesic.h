// Polar coordinates on a surface: how far from a point, and in which direction one sets out.
#pragma once

#include <vector>

#include "object/object.h"

namespace hydrodip {

// A mesh cut finer for computing on it: every triangle into per_side^2 equal ones.
class FineMesh {
 public:
  FineMesh(const TriangleMesh& mesh, int per_side);

  const TriangleMesh& mesh() const { return mesh_; }
  int per_side() const { return per_side_; }
  // The fine triangle that a point of the coarse mesh lies in, and where in it.
  SurfacePoint fine(const SurfacePoint& point) const;

 private:
  TriangleMesh mesh_;
  int per_side_;
};

struct PolarMap {
  // Per vertex: distance times direction, in the plane of `right` and `up` at the centre. Beyond
  // the farthest distance asked for not exact, and far beyond it not finite.
  std::vector<Vec2> place_mm;
};

// Along shortest ways over the surface, which a triangle's plane carries on exactly: exact where
// the surface can be unrolled, else as good as its triangles are small (Melvaer and Reimers,
// "Geodesic polar coordinates on polygonal meshes", 2012). Throws Cancelled.
PolarMap polar_map(const TriangleMesh& mesh, const SurfacePoint& centre, const Vec3& right,
                   const Vec3& up, double farthest_mm);

}  // namespace hydrodip
