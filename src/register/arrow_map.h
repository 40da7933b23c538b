// A picture of a sheet with arrows on it, much longer than what they stand for.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

#include "base/math.h"

namespace hydrodip {

struct Arrow {
  Vec2 from_mm = Vec2::Zero();  // film coordinates
  Vec2 by_mm = Vec2::Zero();
};

// The longest arrow is as long as a sixteenth of the sheet, or as the distance to the next one;
// below stand a scale and how much longer arrows are than true.
Image draw_arrow_map(double width_mm, double height_mm, double margin_mm,
                     const std::vector<Arrow>& arrows, const std::string& title,
                     const std::vector<std::string>& lines);

}  // namespace hydrodip
