#include "ink/device.h"

#include <algorithm>

namespace hydrodip {

namespace {

// amount * coverage / 255, rounded to nearest.
std::uint8_t scaled(int amount, int coverage) {
  return static_cast<std::uint8_t>((amount * coverage + 127) / 255);
}

}  // namespace

std::array<std::uint8_t, 4> device_cmyk(std::uint8_t r, std::uint8_t g, std::uint8_t b,
                                        std::uint8_t a) {
  const int c = 255 - r;
  const int m = 255 - g;
  const int y = 255 - b;
  const int k = std::min({c, m, y});
  return {scaled(c - k, a), scaled(m - k, a), scaled(y - k, a), scaled(k, a)};
}

}  // namespace hydrodip
