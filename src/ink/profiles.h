// Inside of the colour models: the device formula, for one colour and as an ICC profile.
#pragma once

#include <cstdint>
#include <vector>

#include "ink/color_model.h"

namespace hydrodip {

Inks device_inks(const SrgbColor& color);
SrgbColor device_look(const Inks& inks);

// The formula as an ICC profile (version 2, Lab, tables): what print.tif carries when there is no
// other. Agrees with the formula to a mean CIEDE2000 below 0.5.
std::vector<std::uint8_t> make_device_profile();

}  // namespace hydrodip
