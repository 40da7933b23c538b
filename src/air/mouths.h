// The mouths of a pocket of air: when exactly the last of them closes, and lids over them.
#pragma once

#include <optional>
#include <vector>

#include "air/section.h"
#include "dip/travel.h"

namespace hydrodip {

// The water's plane at a moment, in the object's frame.
Plane water_at(const Moment& moment);

// How far the object has travelled when the surface parts all these points, moved along the water's
// normal into its plane, from what they are joined with at `open_mm`. Empty if the sections do not
// tell: they part nothing until `closed_mm`.
std::optional<double> closing(const TriangleMesh& object, const Travel& travel,
                              const std::vector<Vec3>& points, double open_mm, double closed_mm,
                              double max_gap_mm);

// Appends the part of the plane around each of the points that the surface bounds, facing down.
// Loops within it that surround one of `others` are left out. Returns for how many points there is
// such a part.
std::size_t add_lids(const TriangleMesh& object, const Plane& plane,
                     const std::vector<Vec3>& points, const std::vector<Vec3>& others,
                     double max_gap_mm, TriangleMesh& lids);

}  // namespace hydrodip
