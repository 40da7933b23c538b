// How long each cell around an object stays in touch with the open air while the water rises.
#pragma once

#include <cstdint>
#include <vector>

#include "air/cells.h"

namespace hydrodip {

// Moments are counted; a cell that never gets wet has a number beyond the last.
struct Flood {
  static constexpr std::uint16_t kInside = 0xffff;  // no way in from outside: the object's inside

  // Per cell: the moment at which its last way up to the open air is under water. The way from the
  // outside that stays open longest decides: closed = max over ways of min over its cells of wet.
  std::vector<std::uint16_t> closed;
  // The cell before it on that way; its own number on the border.
  std::vector<std::uint32_t> from;

  // It is still dry when its last way out closes.
  bool is_trapped(std::size_t cell, const std::vector<std::uint16_t>& wet) const {
    return closed[cell] != kInside && closed[cell] < wet[cell];
  }
};

// `wet`: per cell, the moment at which its centre gets under water. Throws Cancelled.
Flood flood(const AirCells& cells, const std::vector<std::uint16_t>& wet);

}  // namespace hydrodip
