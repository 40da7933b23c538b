// What a picture's file says beside its pixels, looked at without unpacking it.
#pragma once

#include <cstdint>
#include <vector>

namespace hydrodip {

// Whether decode_image may show a picture otherwise than a reader that goes by pixels alone does:
// it has a colour profile, other colours than red, green and blue, or lies turned; or it is of a
// kind that not every machine's librsvg reads (WebP, TIFF, GIF, BMP).
bool says_more_than_pixels(const std::vector<std::uint8_t>& bytes);

}  // namespace hydrodip
