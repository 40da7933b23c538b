// The strips of marks on the tank's rim, which tell a photo where it was taken from.
#pragma once

#include <vector>

#include "tags/mark.h"

namespace hydrodip {

inline constexpr int kBoardStrips = 5;  // on one page
inline constexpr int kStripMarks = 10;  // five in each of two rows
inline constexpr double kStripLength_mm = 180, kStripHeight_mm = 36;

// Of strip 0 to kBoardStrips - 1, in its own frame: mm from its middle, x along it.
std::vector<MarkPlace> strip_marks(int strip);

// Which strip a tag belongs to, and where its corner lies on it. Strip -1: none.
struct StripPlace {
  int strip = -1;
  Vec2 corner = Vec2::Zero();
};
StripPlace strip_place(int tag);

}  // namespace hydrodip
