// How different two colours look.
#pragma once

#include "image/color_difference.h"
#include "ink/color_model.h"

namespace hydrodip {

// CIEDE2000 between two sRGB colours. 1 is about the least that one sees side by side.
inline double color_difference(const SrgbColor& a, const SrgbColor& b) {
  const auto lab = [](const SrgbColor& c) {
    return to_cielab({srgb_to_linear(c.r), srgb_to_linear(c.g), srgb_to_linear(c.b), 1});
  };
  return ciede2000(lab(a), lab(b));
}

}  // namespace hydrodip
