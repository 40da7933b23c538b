// Where feet go on the contact line.
#pragma once

#include <optional>

#include "dip/waterline.h"

namespace hydrodip {

// Refers to the line. cell_mm: the film's.
struct LineSearch {
  const Waterline& line;
  double cell_mm;

  // The contact line next to a place, as the object's faces have it; nothing if none is near.
  std::optional<Waterline::Point> near(const Vec2& place) const;
  // With its outward direction turned round if it is against `outside`, a unit vector known to
  // point away from the object more or less: where faces are turned the wrong way, that decides.
  static Waterline::Point outwards(Waterline::Point point, const Vec2& outside);
  // Both, or the place itself where no line is near: there the object is a wall.
  Waterline::Point line_near(const Vec2& place, const Vec2& outside) const;

  // Where the edge from a vertex that attaches now leaves the object; next to the vertex where it
  // does not (on walls and overhangs), but never on the far side of it, nor at `to`.
  Waterline::Point first_on_line(const Vec2& from, const Vec2& to) const;

  // Where a foot goes next: towards the floating vertex, so that it stays by the edge whose strain
  // it uses. Nothing where the water does not gain on it that way (on walls and overhangs, or just
  // before contact) or where it would jump further than kMaxJump cells: then it has lost its
  // contact line (the object is submerged there, or a shelf begins). Where it does not go that way
  // it goes straight up, to the line next to it.
  std::optional<Waterline::Point> ahead(const Vec2& from, const Vec2& floating) const;

  static constexpr double kMaxJump = 2.5;
};

}  // namespace hydrodip
