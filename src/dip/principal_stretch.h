// How far a film triangle is stretched, along and across.
#pragma once

#include <array>

#include "base/math.h"

namespace hydrodip {

// Singular values of dX/du.
struct PrincipalStretches {
  double largest = 1, least = 1;
};

// Of a triangle with these corners in the flat film (counter-clockwise, mm) and in space.
PrincipalStretches principal_stretches(const std::array<Vec2, 3>& flat,
                                       const std::array<Vec3, 3>& placed);

}  // namespace hydrodip
