// Ink amounts by a plain device formula (no profile): c = 1 - r etc. on sRGB values, grey
// component moved to black (full replacement). The paper's case.
#pragma once

#include <array>
#include <cstdint>

namespace hydrodip {

// sRGB 8-bit and alpha (coverage) to c, m, y, k in [0, 255].
std::array<std::uint8_t, 4> device_cmyk(std::uint8_t r, std::uint8_t g, std::uint8_t b,
                                        std::uint8_t a);

}  // namespace hydrodip
