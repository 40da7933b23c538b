// Marks in a picture: found by their tags, placed by their corners.
#pragma once

#include <cstdint>
#include <vector>

#include "base/context.h"
#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

// 8-bit brightness.
struct GrayImage {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> value;

  std::uint8_t at(int x, int y) const {
    return value[std::size_t(y) * std::size_t(width_px) + std::size_t(x)];
  }
};
GrayImage gray_of(const Image& image);       // what is transparent is white
GrayImage mirrored(const GrayImage& image);  // left and right exchanged

struct SeenMark {
  int id = 0;
  Vec2 corner_px = Vec2::Zero();  // pixel centres at +0.5; y down
  double cell_px = 0;             // of the tag, on average
};

// Every mark whose tag is read and beside whose tag four squares meet, ordered by id and place.
// Tags without such a corner are left out. Tags are read with at most one wrong bit (of the 36,
// in which two tags differ by 11 or more). In marks of 3 pixels a cell and more corners are good to
// about 0.05 px. Throws Cancelled between pictures, not within one.
std::vector<SeenMark> find_marks(const GrayImage& image, const RunContext& context);

}  // namespace hydrodip
