// Where feet go on the contact line.
#pragma once

#include "dip/waterline.h"

namespace hydrodip {

// Refers to the line. cell_mm: the film's.
struct LineSearch {
  const Waterline& line;
  double cell_mm;

  // The contact line next to `near`, or `near` itself where there is none: there the object is a
  // wall. `outside` is a unit vector known to point away from the object more or less; where faces
  // are turned the wrong way, it decides.
  Waterline::Point line_near(const Vec2& near, const Vec2& outside) const;

  // Where the edge from a vertex that attaches now leaves the object; next to the vertex where it
  // does not (on walls and overhangs), but never on the far side of it.
  Waterline::Point first_on_line(const Vec2& from, const Vec2& to) const;

  // Towards the floating vertex, so that the foot stays by the edge whose strain it uses; straight
  // up where the water does not gain on it that way: on walls and overhangs, or just before
  // contact. A foot that jumps further than kMaxJump cells in one step has lost its contact line
  // (the object is submerged there, or a shelf begins) and goes on straight up, too.
  Waterline::Point next_on_line(const Vec2& from, const Vec2& floating, const Vec2& outward) const;

  static constexpr double kMaxJump = 2.5;
};

}  // namespace hydrodip
