// How different two colours look.
#pragma once

#include "ink/color_model.h"

namespace hydrodip {

// CIEDE2000 between two sRGB colours. 1 is about the least that one sees side by side.
double color_difference(const SrgbColor& a, const SrgbColor& b);

}  // namespace hydrodip
