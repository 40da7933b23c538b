#include "image/decoders.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/run_scope.h"

namespace hydrodip {

namespace {

constexpr std::uint32_t kMaxSide_px = 1u << 15;
constexpr double kMaxPixels = 1u << 28;  // 1 GiB as RGBA

}  // namespace

void refuse_picture(const std::string& name, const char* kind, const std::string& why) {
  throw InputError(
      fmt::format("{}: damaged or truncated {} image ({}); save it again from an image editor.",
                  name, kind, why));
}

// A few bytes may claim any size; believe only what such a file could possibly hold, so that a
// forged header cannot ask for gigabytes.
void check_picture_size(const std::string& name, const char* kind, std::uint32_t width,
                        std::uint32_t height, double smallest_file_bytes, std::size_t file_bytes) {
  if (width == 0 || height == 0) refuse_picture(name, kind, "it has no pixels");
  if (width > kMaxSide_px || height > kMaxSide_px)
    throw InputError(
        fmt::format("{}: the image is {} x {} px, more than {} px a side; scale it down.", name,
                    width, height, kMaxSide_px));
  const double pixels = double(width) * height;
  if (pixels > kMaxPixels)
    throw InputError(fmt::format(
        "{}: the image is {} x {} px and would take {:.1f} GB of memory; scale it down to 16384 x "
        "16384 px or fewer.",
        name, width, height, 4 * pixels / 1e9));
  if (smallest_file_bytes > double(file_bytes))
    refuse_picture(name, kind, "too few bytes for its size");
}

int exif_orientation(std::span<const std::uint8_t> exif) {
  if (exif.size() < 8 || exif[0] != exif[1] || (exif[0] != 'I' && exif[0] != 'M')) return 1;
  const bool little = exif[0] == 'I';
  const auto number = [&](std::size_t at, std::size_t bytes) -> std::uint32_t {
    if (at > exif.size() || exif.size() - at < bytes) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value = value << 8 | exif[at + (little ? bytes - 1 - i : i)];
    return value;
  };
  const std::size_t directory = number(4, 4);
  const std::uint32_t entries = number(directory, 2);
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + std::size_t(12) * i;
    if (entry + 12 > exif.size()) break;
    if (number(entry, 2) != 0x0112) continue;
    const std::uint32_t value = number(entry + 8, 2);
    return value >= 1 && value <= 8 ? int(value) : 1;
  }
  return 1;
}

Image oriented(Image image, int orientation) {
  if (orientation <= 1 || orientation > 8) return image;
  const bool swapped = orientation >= 5;  // rows become columns
  const bool right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool down = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  const int width = image.width_px, height = image.height_px;
  Image out = swapped ? Image(height, width) : Image(width, height);
  for (int y = 0; y < out.height_px; ++y) {
    check_cancelled();
    for (int x = 0; x < out.width_px; ++x) {
      // 6: the picture's left column, read from below, is the first row shown.
      int from_x = swapped ? y : x, from_y = swapped ? x : y;
      if (right) from_x = width - 1 - from_x;
      if (down) from_y = height - 1 - from_y;
      std::copy_n(image.pixel(from_x, from_y), 4, out.pixel(x, y));
    }
  }
  return out;
}

}  // namespace hydrodip
