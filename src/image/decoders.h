// One decoder per kind of picture, for files.cpp. All throw InputError naming `name`, refuse
// pictures too large to unpack before they do, and bring everything to 8-bit RGBA.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"

namespace hydrodip {

using PictureBytes = std::vector<std::uint8_t>;

// A picture as stored, with what says how to show it.
struct StoredPicture {
  Image image;
  PictureBytes profile;  // ICC, or empty
  std::optional<std::array<std::uint8_t, 4>>
      cicp;             // PNG's: primaries, transfer, matrix, full range
  int orientation = 1;  // EXIF's, 1 to 8
  // Four inks instead of RGBA, 255 for most: the profile says what they show.
  bool inks = false;
};

StoredPicture decode_webp(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_gif(const PictureBytes& bytes, const std::string& name);  // the first frame
StoredPicture decode_tiff(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_bmp(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_tga(const PictureBytes& bytes, const std::string& name);
bool looks_like_tga(const PictureBytes& bytes);  // the format has no mark

// The orientation that EXIF data states (from "II" or "MM" on), 1 if none.
int exif_orientation(std::span<const std::uint8_t> exif);
// As the orientation wants it seen.
Image oriented(Image image, int orientation);

// Brings the colours to sRGB, as the ICC profile (of RGB or grey) or PNG's cICP numbers say. Leaves
// them alone if these cannot be used (damaged, HDR), or mean sRGB anyhow.
void bring_to_srgb(Image& image, const PictureBytes& profile);
// From StoredPicture::inks to opaque sRGB. The profile is one of four inks.
void bring_inks_to_srgb(Image& image, const PictureBytes& profile);
// Whether a profile is one of four inks, from which colours can be told.
bool is_ink_profile(const PictureBytes& profile);
void bring_to_srgb(Image& image, const std::array<std::uint8_t, 4>& cicp);

[[noreturn]] void refuse_picture(const std::string& name, const char* kind, const std::string& why);
// Throws for no pixels, more than 2^15 px a side or 2^28 px in all, and for more than a file of
// that many bytes can hold.
void check_picture_size(const std::string& name, const char* kind, std::uint32_t width,
                        std::uint32_t height, double smallest_file_bytes, std::size_t file_bytes);

}  // namespace hydrodip
