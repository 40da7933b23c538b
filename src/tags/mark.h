// A printed mark: an AprilTag (family 36h11) that says which one it is, beside the corner of four
// checker squares that says where. Seen with the tag upright, the corner is on its right, so that
// turned and mirrored marks are told apart.
#pragma once

#include <vector>

#include "base/math.h"

namespace hydrodip {

// Both the tag (with its white edge) and the four squares are so many cells long and wide.
inline constexpr int kMarkCells = 10;

struct MarkPlace {
  int id = 0;                  // below kTagCount
  Vec2 corner = Vec2::Zero();  // where the four squares meet, mm
  Vec2 along = Vec2::UnitX();  // from the tag to the corner: +x, -x, +y or -y
  double cell_mm = 0.64;
};

inline constexpr int kTagCount = 587;

// What is black of it, as rectangles that overlap rather than abut. y is up; the plane is seen from
// the printed side. Throws std::out_of_range for an unknown id.
std::vector<Box2> mark_boxes(const MarkPlace& mark);

// The rectangle that holds tag and squares.
Box2 mark_outline(const MarkPlace& mark);

}  // namespace hydrodip
