// The library of AprilTags, behind types of our own.
#pragma once

#include <array>
#include <vector>

#include "tags/mark.h"
#include "tags/seen_marks.h"

namespace hydrodip {

// Black cells of a tag, its white edge included: [row from the top][column].
using TagCells = std::array<std::array<bool, kMarkCells>, kMarkCells>;
TagCells tag_cells(int id);

struct SeenTag {
  int id = 0;
  Mat3 to_px;  // homography: from the tag's middle in cells, x right and y down, to pixels
};
std::vector<SeenTag> find_tags(const GrayImage& image);

}  // namespace hydrodip
