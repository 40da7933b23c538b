// What hangs over a triangle: what rays that leave it could meet, whichever of its points they
// leave from.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// A triangle and the ways in which rays leave its corners (unit vectors). Between the corners a ray
// must go a way that adds up from these with weights that are not negative: as parallel rays do,
// and those that leave an axis or a centre.
struct LeavingRays {
  int triangle = -1;
  std::array<Vec3, 3> ways;
};

// Immutable once built; keeps a reference to the mesh. Safe to ask from many threads.
class Overhang {
 public:
  explicit Overhang(const TriangleMesh& mesh);

  // The triangles near one that are best asked together with it; itself among them.
  std::span<const int> together(int triangle) const;

  // In place of what `clear` held, for each of them: 1 if no ray that leaves the triangle meets
  // another one further away from its plane than 2e-5 mm; 0 if some may, or if one leaves it at too
  // flat an angle to tell, or on another side than others. What only touches the space that rays go
  // through is not met. The answer about a triangle does not depend on which others are asked with
  // it.
  void are_clear(std::span<const LeavingRays> leaving, std::vector<std::uint8_t>& clear) const;

 private:
  struct HalfSpace {
    Vec3 out;
    double most;  // inside: out . x <= most
  };
  using Corners = std::array<Vec3, 3>;
  struct Candidate {
    int triangle;
    Corners corners;
  };

  Corners corners_of(int triangle) const;
  bool is_clear(const LeavingRays& leaving, const std::vector<Candidate>& candidates) const;
  std::vector<HalfSpace> reach_of(const LeavingRays& leaving) const;
  std::vector<HalfSpace> reach_of(std::span<const LeavingRays> leaving) const;
  void look_for(const std::vector<HalfSpace>& reach, std::vector<Candidate>& candidates) const;

  const TriangleMesh& mesh_;
  std::vector<int> order_;  // triangles along the Z-order curve, so that a few in a row are near
  std::vector<int> place_;  // of a triangle in it
  // Boxes of a few triangles in a row, boxes of a few of these, and so on up to one of all.
  std::vector<std::vector<Box3>> levels_;
};

}  // namespace hydrodip
