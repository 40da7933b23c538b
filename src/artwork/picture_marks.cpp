#include "artwork/picture_marks.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "image/decoders.h"

namespace hydrodip {
namespace {

using Bytes = std::span<const std::uint8_t>;

bool begins(Bytes bytes, std::string_view mark) {
  return bytes.size() >= mark.size() &&
         std::equal(mark.begin(), mark.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return std::uint8_t(a) == b; });
}

std::size_t big_endian(Bytes bytes) {
  std::size_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8U | byte;
  return value;
}

// C0 to CF but tables and extensions, whose data have the number of channels as their sixth byte.
bool begins_frame(int marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool jpeg_says_more(Bytes bytes) {
  constexpr std::string_view kExif("Exif\0\0", 6), kProfile("ICC_PROFILE\0", 12);
  constexpr int kPixels = 0xda;
  for (bytes = bytes.subspan(2); bytes.size() >= 4 && bytes[0] == 0xff;) {
    const int marker = bytes[1];
    if (marker == 0xff) {  // a filling byte
      bytes = bytes.subspan(1);
      continue;
    }
    const std::size_t length = big_endian(bytes.subspan(2, 2));
    if (marker == kPixels || length < 2 || length > bytes.size() - 2) return false;
    const Bytes data = bytes.subspan(4, length - 2);
    if (begins(data, kProfile)) return true;
    if (begins(data, kExif) && exif_orientation(data.subspan(kExif.size())) != 1) return true;
    if (begins_frame(marker) && data.size() > 5 && data[5] == 4) return true;
    bytes = bytes.subspan(2 + length);
  }
  return false;
}

}  // namespace

bool says_more_than_pixels(const std::vector<std::uint8_t>& bytes) {
  if (is_png(bytes)) return png_says_more(bytes);
  if (is_jpeg(bytes)) return jpeg_says_more(bytes);
  return begins(bytes, "RIFF") || begins(bytes, std::string_view("II*\0", 4)) ||
         begins(bytes, std::string_view("MM\0*", 4)) || begins(bytes, "GIF8") ||
         begins(bytes, "BM");
}

}  // namespace hydrodip
