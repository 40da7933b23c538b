// Pictures of which most stays blank.
#pragma once

#include "base/blank_pages.h"
#include "image/image.h"

namespace hydrodip {

// Image(width, height), but what is never written to takes no memory.
inline Image blank_image(int width_px, int height_px) {
  Image image;
  image.width_px = width_px;
  image.height_px = height_px;
  image.rgba = blank<std::uint8_t>(std::size_t(4) * std::size_t(width_px) * std::size_t(height_px));
  return image;
}

}  // namespace hydrodip
