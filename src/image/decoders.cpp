#include "image/decoders.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/math.h"
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

void warn_of_left_out(int channels, const std::string& name) {
  if (channels < 1) return;
  const bool one = channels == 1;
  warn(fmt::format(
      "{}: {} not marked as transparency (saved selections and spot inks are not) and {} "
      "left out.",
      name,
      one ? "a channel beside its colours is"
          : fmt::format("{} channels beside its colours are", channels),
      one ? "is" : "are"));
}

void divide_by_alpha(std::uint8_t* values, int count, int alpha) {
  if (alpha == 0 || alpha == 255) return;
  for (int c = 0; c < count; ++c)
    values[c] = std::uint8_t(std::min(255, (values[c] * 255 + alpha / 2) / alpha));
}

void bring_inks_to_srgb(Image& image) {
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    check();
    const int light = 255 - image.rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      image.rgba[i + c] = std::uint8_t(((255 - image.rgba[i + c]) * light + 127) / 255);
    image.rgba[i + 3] = 255;
  }
}

namespace {

// EXIF's first directory.
class Exif {
 public:
  explicit Exif(std::span<const std::uint8_t> bytes)
      : bytes_(bytes),
        is_exif_(bytes.size() >= 8 && bytes[0] == bytes[1] &&
                 (bytes[0] == 'I' || bytes[0] == 'M')) {}

  // Of a short number; 0 if it is not there.
  std::uint32_t short_of(std::uint32_t tag) const {
    const std::size_t value = value_of(tag);
    return value > 0 ? number(value, 2) : 0;
  }
  // Of a fraction; 0 if it is not there.
  double fraction_of(std::uint32_t tag) const {
    const std::size_t value = value_of(tag);
    if (value == 0) return 0;
    const std::size_t at = number(value, 4);
    const double under = number(at + 4, 4);
    return under > 0 ? number(at, 4) / under : 0;
  }

 private:
  // Where it stands; 0 for nowhere.
  std::size_t value_of(std::uint32_t tag) const {
    if (!is_exif_) return 0;
    const std::size_t directory = number(4, 4);
    const std::uint32_t entries = number(directory, 2);
    for (std::uint32_t i = 0; i < entries; ++i) {
      const std::size_t entry = directory + 2 + std::size_t(12) * i;
      if (entry + 12 > bytes_.size()) break;
      if (number(entry, 2) == tag) return entry + 8;
    }
    return 0;
  }

  std::uint32_t number(std::size_t at, std::size_t count) const {
    if (at > bytes_.size() || bytes_.size() - at < count) return 0;
    const bool little = bytes_[0] == 'I';
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
      value = value << 8 | bytes_[at + (little ? count - 1 - i : i)];
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  bool is_exif_;
};

}  // namespace

int exif_orientation(std::span<const std::uint8_t> exif) {
  const std::uint32_t value = Exif(exif).short_of(0x0112);
  return value >= 1 && value <= 8 ? int(value) : 1;
}

Resolution exif_resolution(std::span<const std::uint8_t> exif) {
  constexpr double kUnknown_dpi = 72;  // is to be written then
  constexpr std::uint32_t kCentimetres = 3;
  const Exif tags(exif);
  const double per_unit = tags.short_of(0x0128) == kCentimetres ? kMmPerInch / 10 : 1;
  const Resolution found{tags.fraction_of(0x011a) * per_unit, tags.fraction_of(0x011b) * per_unit};
  return found.across_dpi == kUnknown_dpi ? Resolution() : found;
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
