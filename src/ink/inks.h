// What a printer lays down: amounts of cyan, magenta, yellow and black.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/blank_array.h"

namespace hydrodip {

// Amounts in [0, 1]: 1 is as much as one pass of the printer gives. While they are being computed
// they may be more.
struct Inks {
  float c = 0, m = 0, y = 0, k = 0;

  // c + m + y + k, from 0 to 4.
  float density() const { return c + m + y + k; }
  Inks times(float factor) const { return {c * factor, m * factor, y * factor, k * factor}; }
};

// Inks of every pixel, 255 is 1. Row 0 is the top row.
struct InkImage {
  int width_px = 0;
  int height_px = 0;
  BlankArray<std::uint8_t> cmyk;  // 4 * width_px * height_px

  InkImage() = default;
  InkImage(int width, int height)  // no ink
      : width_px(width),
        height_px(height),
        cmyk(std::size_t(4) * std::size_t(width) * std::size_t(height)) {}

  std::uint8_t* pixel(int x, int y) {
    return cmyk.data() + 4 * (std::size_t(y) * std::size_t(width_px) + std::size_t(x));
  }
  const std::uint8_t* pixel(int x, int y) const {
    return cmyk.data() + 4 * (std::size_t(y) * std::size_t(width_px) + std::size_t(x));
  }
  bool empty() const { return cmyk.empty(); }
};

// To the nearest of 256 amounts; clamps.
std::array<std::uint8_t, 4> to_bytes(const Inks& inks);
Inks from_bytes(const std::uint8_t* cmyk);
// Whether there is no ink in it, as on most of a sheet.
inline bool is_blank(const std::uint8_t* cmyk) {
  return (cmyk[0] | cmyk[1] | cmyk[2] | cmyk[3]) == 0;
}

}  // namespace hydrodip
