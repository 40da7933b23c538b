// Image files in and out: the only place that knows libpng and libjpeg (libtiff: sheet/tiff.cpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

namespace hydrodip {

// Decodes PNG or JPEG (told apart by their first bytes), any bit depth, palette, grey, interlaced;
// 16-bit is reduced to 8. `name` is used in the error only. A PNG with a gamma or embedded profile
// other than sRGB is read as sRGB. Throws InputError: not an image, truncated, over 2^15 px a side.
Image decode_image(const std::vector<std::uint8_t>& bytes, const std::string& name);

// read_file + decode_image.
Image load_image(const std::filesystem::path& path);

// Dots per inch recorded in a PNG (pHYs) or JPEG (JFIF density); 0 when there is none.
double recorded_dpi(const std::vector<std::uint8_t>& bytes);

// Writes RGBA, or RGB when every pixel is opaque, with an sRGB chunk and, if dpi > 0, pHYs.
// The bytes depend on the pixels alone. Throws InputError if the file cannot be written.
void save_png(const std::filesystem::path& path, const Image& image, double dpi = 0);

// The same into memory (for GLB and HTML).
std::vector<std::uint8_t> encode_png(const Image& image, double dpi = 0);

// JPEG for pictures inside other files, where size counts; quality 1 to 100. Alpha is dropped.
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

}  // namespace hydrodip
