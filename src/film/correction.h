// A smooth field of displacements over the sheet: how much farther than its film model says what is
// meant for a place is to be printed, as earlier dips have shown it.
#pragma once

#include <vector>

#include "base/math.h"

namespace hydrodip {

struct FilmCorrection {
  Vec2 first = Vec2::Zero();  // film coordinate of move[0], mm
  double pitch_mm = 5;        // of the grid
  int nx = 0, ny = 0;
  std::vector<Vec2> move;  // mm, [j * nx + i]

  // Between the grid's points cubic (Catmull and Rom), beyond its edge as on it; nothing without
  // any points.
  Vec2 at(const Vec2& u) const;
  // In x or y, at any of the grid's points; infinity if one is no number.
  double farthest_mm() const;
};

}  // namespace hydrodip
