// Smooth normals for pictures: what a curved surface that the triangles stand for would have.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"

namespace hydrodip {

using CornerNormals = std::array<Vec3, 3>;

// Unit normal per triangle corner: the mean, weighted by angle, of the faces around that point
// (vertices at equal positions count as one) that lie within crease_deg of this face. A degenerate
// triangle gets (0, 0, 1).
std::vector<CornerNormals> corner_normals(const std::vector<Vec3>& positions,
                                          const std::vector<Triangle>& triangles,
                                          double crease_deg = 40);

// Unit normal between the corners at barycentric (1 - u - v, u, v); zero where they cancel out.
Vec3 normal_between(const CornerNormals& corners, double u, double v);

}  // namespace hydrodip
