// Images at another size.
#pragma once

#include "image/image.h"

namespace hydrodip {

// Area-averaged in linear light, colours weighted by their alpha. Sizes in [1, 2^15] px.
Image resize(const Image& image, int width_px, int height_px);

// The image itself, or a smaller one of the same shape whose longer side is max_side_px.
Image shrink_to(const Image& image, int max_side_px);

}  // namespace hydrodip
