#include "image/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <new>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/picture_file.h"

namespace hydrodip {

namespace {

using Bytes = PictureBytes;

bool begins(const Bytes& bytes, std::string_view mark, std::size_t at = 0) {
  return bytes.size() >= at + mark.size() && std::memcmp(&bytes[at], mark.data(), mark.size()) == 0;
}

bool is_tiff(const Bytes& bytes) {
  return begins(bytes, std::string_view("II*\0", 4)) ||
         begins(bytes, std::string_view("MM\0*", 4)) ||
         begins(bytes, std::string_view("II+\0", 4)) || begins(bytes, std::string_view("MM\0+", 4));
}

// Kinds that people have and that are not read.
const char* foreign_kind(const Bytes& bytes) {
  if (begins(bytes, "8BPS")) return "a Photoshop file";
  if (begins(bytes, "\xabKTX 20")) return "a KTX2 (Basis Universal) texture";
  if (begins(bytes, "DDS ")) return "a DDS texture";
  if (begins(bytes, "ftypheic", 4) || begins(bytes, "ftypmif1", 4)) return "a HEIC picture";
  if (begins(bytes, "ftypavif", 4)) return "an AVIF picture";
  if (begins(bytes, "\x76\x2f\x31\x01")) return "an OpenEXR picture";
  if (begins(bytes, "#?RADIANCE")) return "a Radiance HDR picture";
  if (begins(bytes, "\xff\x0a") || begins(bytes, "JXL ", 4)) return "a JPEG XL picture";
  if (begins(bytes, "<svg")) return "an SVG drawing";
  if (begins(bytes, "<?xml")) return "a text in XML, as SVG drawings are";
  if (begins(bytes, "\x1f\x8b")) return "a file packed by gzip";
  return bytes.empty() ? "an empty file" : nullptr;
}

[[noreturn]] void refuse_kind(const Bytes& bytes, const std::string& name,
                              const std::string& other_kind) {
  const char* foreign = foreign_kind(bytes);
  throw InputError(fmt::format("{}: {}; give a PNG, JPEG, WebP, TIFF, GIF, BMP{} file.", name,
                               foreign ? fmt::format("{}, which is not read", foreign)
                                       : "not a picture of a kind that is read",
                               other_kind.empty() ? " or TGA" : ", TGA or " + other_kind));
}

bool is_webp(const Bytes& bytes) { return begins(bytes, "RIFF") && begins(bytes, "WEBP", 8); }

// By its first bytes; TGA has no mark.
bool may_be_picture(const Bytes& bytes) {
  return is_png(bytes) || is_jpeg(bytes) || is_webp(bytes) || begins(bytes, "GIF8") ||
         is_tiff(bytes) || begins(bytes, "BM") ||
         (foreign_kind(bytes) == nullptr && looks_like_tga(bytes));
}

StoredPicture decode_any(const Bytes& bytes, const std::string& name,
                         const std::string& other_kind) {
  if (is_png(bytes)) return decode_png(bytes, name);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, name);
  if (is_webp(bytes)) return decode_webp(bytes, name);
  if (begins(bytes, "GIF8")) return decode_gif(bytes, name);
  if (is_tiff(bytes)) return decode_tiff(bytes, name);
  if (begins(bytes, "BM")) return decode_bmp(bytes, name);
  if (foreign_kind(bytes) == nullptr && looks_like_tga(bytes)) return decode_tga(bytes, name);
  refuse_kind(bytes, name, other_kind);
}

void bring_inks_to_srgb(StoredPicture& picture) {
  if (picture.profile.empty())
    bring_inks_to_srgb(picture.image);
  else
    bring_inks_to_srgb(picture.image, picture.profile);
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < picture.ink_alpha.size(); ++i) {
    check();
    picture.image.rgba[4 * i + 3] = picture.ink_alpha[i];
  }
}

// PNG's cICP goes before a profile. What cannot be used is told.
void bring_colors_to_srgb(StoredPicture& picture, const std::string& name) {
  if (picture.cicp) {
    if (bring_to_srgb(picture.image, *picture.cicp)) {
      picture.profile_lost = false;
      return;
    }
    if (picture.profile.empty())
      warn(fmt::format(
          "{}: its colours are coded in a way that is not read (cICP {}, {}, {}, {}) "
          "and are taken as sRGB; save it as sRGB from an image editor.",
          name, (*picture.cicp)[0], (*picture.cicp)[1], (*picture.cicp)[2], (*picture.cicp)[3]));
  }
  if (!picture.profile.empty() && !bring_to_srgb(picture.image, picture.profile))
    picture.profile_lost = true;
}

void bring_to_srgb(StoredPicture& picture, const std::string& name) {
  switch (picture.stored) {
    case Stored::kColors:
      bring_colors_to_srgb(picture, name);
      break;
    case Stored::kInks:
      bring_inks_to_srgb(picture);
      break;
    case Stored::kLab:
      bring_lab_to_srgb(picture);
      break;
  }
  if (picture.profile_lost)
    warn(
        fmt::format("{}: its colour profile is damaged or does not fit such a picture, and is not "
                    "used: {}; save it as sRGB from an image editor.",
                    name,
                    picture.stored == Stored::kInks ? "its inks show what a plain formula makes of "
                                                      "them"
                                                    : "its colours are taken as sRGB"));
}

}  // namespace

void warn_of_damage(const std::string& name) {
  warn(fmt::format(
      "{}: its data are damaged, and parts of the picture may be wrong; take it anew from where it "
      "came from.",
      name));
}

Image decode_image(const Bytes& bytes, const std::string& name, const std::string& other_kind) {
  try {
    StoredPicture picture = decode_any(bytes, name, other_kind);
    if (picture.damaged) warn_of_damage(name);
    if (picture.has_more)
      warn(fmt::format("{}: the file holds several pictures (pages or frames); the first is taken.",
                       name));
    bring_to_srgb(picture, name);
    return oriented(std::move(picture.image), picture.orientation);
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: not enough memory for this image; scale it down.", name));
  }
}

std::vector<std::uint8_t> read_picture(const std::filesystem::path& path) {
  // 2^28 pixels of four 16-bit values, stored plainly, and some room.
  constexpr std::uintmax_t kLargest = (std::uintmax_t(1) << 31) + (std::uintmax_t(1) << 26);
  constexpr std::size_t kFirst = 4096;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return read_file(path);
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  std::ifstream file(path, std::ios::binary);
  Bytes first(kFirst);
  file.read(reinterpret_cast<char*>(first.data()), kFirst);
  first.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  // What cannot be opened is said by read_file.
  if (!first.empty() && !may_be_picture(first)) refuse_kind(first, path.string(), {});
  if (size > kLargest)
    throw InputError(
        fmt::format("{}: has {:.1f} GB, more than any picture that is read; scale it "
                    "down.",
                    path.string(), double(size) / 1e9));
  return read_file(path);
}

Image load_image(const std::filesystem::path& path) {
  return decode_image(read_picture(path), path.string());
}

Resolution recorded_resolution(const Bytes& bytes) {
  if (is_png(bytes)) return png_resolution(bytes);
  if (is_jpeg(bytes)) return jpeg_resolution(bytes);
  return is_tiff(bytes) ? tiff_resolution(bytes) : Resolution();
}

double scan_dpi(const Bytes& bytes) {
  const Resolution found = recorded_resolution(bytes);
  return found.is_one() ? found.across_dpi : 0;
}

double recorded_dpi(const Bytes& bytes) {
  return is_tiff(bytes) ? 0 : recorded_resolution(bytes).across_dpi;
}

void save_png(const std::filesystem::path& path, const Image& image, double dpi, bool mirrored) {
  const Bytes bytes = encode_png(image, dpi, mirrored);
  write_file(path, bytes.data(), bytes.size());
}

}  // namespace hydrodip
