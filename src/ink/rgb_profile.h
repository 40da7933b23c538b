// Printers that take red, green and blue and make inks of it themselves: colours for their driver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"
#include "ink/color_model.h"

namespace hydrodip {

// Whether the bytes are the ICC profile of something that takes red, green and blue.
bool is_rgb_profile(const std::vector<std::uint8_t>& bytes);

// An sRGB image in the device values of an RGB printer, by its ICC profile; alpha stays, and so do
// the transparent ends of rows. Relative: with black point compensation. Throws InputError naming
// `name` if the profile cannot be used.
Image in_printer_rgb(Image image, const std::vector<std::uint8_t>& profile, const std::string& name,
                     RenderingIntent intent);

}  // namespace hydrodip
