// The picture on the page, whatever its colours are made of.
#pragma once

#include <array>
#include <cstdint>

#include "image/image.h"
#include "ink/inks.h"

namespace hydrodip {

// Refers to its pixels.
class Picture {
 public:
  // sRGB; what is transparent is white. NOLINTNEXTLINE(google-explicit-constructor)
  Picture(const Image& image)
      : width_px(image.width_px),
        height_px(image.height_px),
        channels(3),
        bytes_(image.rgba.data()) {}
  // Inks. NOLINTNEXTLINE(google-explicit-constructor)
  Picture(const InkImage& image)
      : width_px(image.width_px),
        height_px(image.height_px),
        channels(4),
        bytes_(image.cmyk.data()) {}

  int width_px;
  int height_px;
  int channels;  // 3: r, g, b; 4: c, m, y, k

  // Whether anything is printed there, be it white.
  bool is_printed(int x, int y) const {
    const std::uint8_t* p = at(x, y);
    return channels == 3 ? p[3] != 0 : (p[0] | p[1] | p[2] | p[3]) != 0;
  }

  // The pixel's channels; of sRGB the first three.
  std::array<std::uint8_t, 4> read(int x, int y) const {
    const std::uint8_t* p = at(x, y);
    if (channels == 4) return {p[0], p[1], p[2], p[3]};
    const auto over_white = [&](std::uint8_t value) {
      return static_cast<std::uint8_t>(255 - ((255 - value) * p[3] + 127) / 255);
    };
    return {over_white(p[0]), over_white(p[1]), over_white(p[2]), 0};
  }

 private:
  const std::uint8_t* at(int x, int y) const {
    return bytes_ + 4 * (std::size_t(y) * std::size_t(width_px) + std::size_t(x));
  }
  const std::uint8_t* bytes_;
};

}  // namespace hydrodip
