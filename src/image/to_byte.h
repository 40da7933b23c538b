// Shares of one as bytes.
#pragma once

#include <algorithm>
#include <cstdint>

namespace hydrodip {

// 255 times a share, to the nearest whole number; clamps.
inline std::uint8_t to_byte(float share) {
  const float scaled = 255.0F * std::clamp(share, 0.0F, 1.0F);
  // As std::lround, without the call: it is never negative.
  return static_cast<std::uint8_t>(double(scaled) + 0.5);  // NOLINT(bugprone-incorrect-roundings)
}

}  // namespace hydrodip
