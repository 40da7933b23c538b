// Image files in and out. Each kind has a file of its own (decoders.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

namespace hydrodip {

// Decodes PNG, JPEG, WebP, TIFF, GIF (its first frame), BMP or TGA (told apart by their first
// bytes), any bit depth, palette, grey, interlaced; 16-bit is reduced to 8. Embedded RGB and
// grey profiles, a CMYK JPEG's or TIFF's profile, Lab and PNG's cICP are brought to sRGB, EXIF's
// orientation is applied; a PNG's bare gamma is not. A job that this thread works for (run_scope.h)
// is warned of colours that may be wrong: a damaged profile, damaged data, channels left out.
// `name` is what it is called there and in errors. Throws InputError: not an image, truncated, over
// 2^15 px a side or 2^28 px in all (refused before it is unpacked). `other_kind`: what else its
// caller reads, and found not to be that, as errors name it ("SVG").
Image decode_image(const std::vector<std::uint8_t>& bytes, const std::string& name,
                   const std::string& other_kind = {});

// read_file + decode_image.
Image load_image(const std::filesystem::path& path);

// Dots per inch across, recorded in a PNG (pHYs) or JPEG (JFIF's density, EXIF); 0 when there is
// none.
double recorded_dpi(const std::vector<std::uint8_t>& bytes);

// Writes RGBA, or RGB when every pixel is opaque, with an sRGB chunk and, if dpi > 0, pHYs.
// Mirrored: left is right. The bytes depend on the pixels alone. Throws InputError if the file
// cannot be written.
void save_png(const std::filesystem::path& path, const Image& image, double dpi = 0,
              bool mirrored = false);

// The same into memory (for GLB and HTML).
std::vector<std::uint8_t> encode_png(const Image& image, double dpi = 0, bool mirrored = false);

// JPEG for pictures inside other files, where size counts; quality 1 to 100. Alpha is dropped.
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

}  // namespace hydrodip
