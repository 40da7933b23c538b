// A mesh cut by a plane.
#pragma once

#include <vector>

#include "object/object.h"

namespace hydrodip {

// Points whose height(p) = up.dot(p) - offset is above zero lie above it.
struct Plane {
  Vec3 up = Vec3::UnitZ();  // unit
  double offset = 0;

  double height(const Vec3& point) const { return up.dot(point) - offset; }
  Vec2 flat(const Vec3& point) const;
  Vec3 lifted(const Vec2& flat) const;  // the point of the plane there
};

// Closed, in the plane's own coordinates.
using Loop = std::vector<Vec2>;

// All loops in which the plane cuts the surface. A vertex in the plane counts as above it. Where
// the surface has a gap, the loop is closed across it if it is no wider than max_gap_mm, else
// dropped.
std::vector<Loop> section(const TriangleMesh& mesh, const Plane& plane, double max_gap_mm);

bool encloses(const Loop& loop, const Vec2& point);
double area(const Loop& loop);  // signed

}  // namespace hydrodip
