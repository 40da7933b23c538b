// Pixel buffers. Row 0 is the top row of the picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/blank_array.h"

namespace hydrodip {

// A colour in linear light, straight (not premultiplied) alpha, sRGB primaries, nominally [0, 1].
struct LinearColor {
  float r = 0, g = 0, b = 0, a = 1;
};

inline bool is_white(const LinearColor& c) { return c.r >= 1 && c.g >= 1 && c.b >= 1; }

// IEC 61966-2-1 transfer functions, on [0, 1].
float srgb_to_linear(float encoded);
float linear_to_srgb(float linear);
// Table look-up of srgb_to_linear(byte / 255).
float srgb8_to_linear(std::uint8_t encoded);
// That table, for loops that decode many pixels.
const std::array<float, 256>& srgb8_table();
// Adds a pixel's share of a mean in linear light; premultiplied, so that a colour hidden under
// transparent pixels does not show. `decode` is srgb8_table().
inline void add_pixel(const std::uint8_t* pixel, float weight, const std::array<float, 256>& decode,
                      LinearColor& sum) {
  const float alpha = weight * float(pixel[3]) * (1.0F / 255.0F);
  sum.r += alpha * decode[pixel[0]];
  sum.g += alpha * decode[pixel[1]];
  sum.b += alpha * decode[pixel[2]];
  sum.a += alpha;
}
// Rounds to the nearest byte; clamps.
std::uint8_t linear_to_srgb8(float linear);

// 8-bit sRGB with straight alpha; the form of every file that people open. What is never written to
// takes no memory.
struct Image {
  int width_px = 0;
  int height_px = 0;
  BlankArray<std::uint8_t> rgba;  // 4 * width_px * height_px

  Image() = default;
  Image(int width, int height)  // fully transparent black
      : width_px(width),
        height_px(height),
        rgba(std::size_t(4) * std::size_t(width) * std::size_t(height)) {}

  std::uint8_t* pixel(int x, int y) {
    return rgba.data() + 4 * (std::size_t(y) * std::size_t(width_px) + std::size_t(x));
  }
  const std::uint8_t* pixel(int x, int y) const {
    return rgba.data() + 4 * (std::size_t(y) * std::size_t(width_px) + std::size_t(x));
  }
  bool empty() const { return rgba.empty(); }
};

}  // namespace hydrodip
