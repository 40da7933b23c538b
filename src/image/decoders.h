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
#include "image/picture_file.h"

namespace hydrodip {

using PictureBytes = std::vector<std::uint8_t>;

// What the four bytes of a stored pixel are.
enum class Stored {
  kColors,  // red, green, blue and alpha
  kInks,    // cyan, magenta, yellow and black, 255 for most
  kLab,     // CIE L*, a* and b* under D50, coded as ICC does (100 is 255, 0 is 128), and alpha
};

// A picture as stored, with what says how to show it.
struct StoredPicture {
  Image image;
  PictureBytes profile;  // ICC, or empty; of inks: one from which colours can be told
  std::optional<std::array<std::uint8_t, 4>>
      cicp;             // PNG's: primaries, transfer, matrix, full range
  int orientation = 1;  // EXIF's, 1 to 8
  Stored stored = Stored::kColors;
  PictureBytes ink_alpha;  // a byte for each pixel of inks, or empty: opaque
  // Lab of 16 bits, three values a pixel, coded as ICC's version 2 does (100 is 0xff00, 0 is
  // 0x8000); empty: Lab is in the image.
  std::vector<std::uint16_t> wide_lab;
  bool profile_lost = false;  // the file has one that cannot be used
  bool damaged = false;       // some pixels are not what was meant
  bool has_more = false;      // it is the first of several pages or frames
};

StoredPicture decode_png(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_jpeg(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_webp(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_gif(const PictureBytes& bytes, const std::string& name);  // the first frame
StoredPicture decode_tiff(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_bmp(const PictureBytes& bytes, const std::string& name);
StoredPicture decode_tga(const PictureBytes& bytes, const std::string& name);
// By their marks.
bool is_png(const PictureBytes& bytes);
bool is_jpeg(const PictureBytes& bytes);
// Whether a PNG has a profile, cICP or an orientation.
bool png_says_more(const PictureBytes& bytes);
bool looks_like_tga(const PictureBytes& bytes);  // the format has no mark

// The orientation that EXIF data states (from "II" or "MM" on), 1 if none.
int exif_orientation(std::span<const std::uint8_t> exif);
// The resolution that it states; none if it says 72 dpi, which stands for an unknown one.
Resolution exif_resolution(std::span<const std::uint8_t> exif);
// As the orientation wants it seen.
Image oriented(Image image, int orientation);

// Brings the colours to sRGB, as the ICC profile (of RGB or grey) or PNG's cICP numbers say. Leaves
// them alone if these mean sRGB anyhow, or cannot be used (damaged, HDR, a grey profile beside
// colours): then it is false.
bool bring_to_srgb(Image& image, const PictureBytes& profile);
bool bring_to_srgb(Image& image, const std::array<std::uint8_t, 4>& cicp);
// From Stored::kInks to opaque sRGB: by a profile of four inks, or by a plain device formula.
void bring_inks_to_srgb(Image& image, const PictureBytes& profile);
void bring_inks_to_srgb(Image& image);
// From Stored::kLab, relative to its white. Alpha stays.
void bring_lab_to_srgb(StoredPicture& picture);
// Takes a profile for inks, if it is one from which their colours can be told; else it is lost.
void take_ink_profile(StoredPicture& picture, PictureBytes profile);

// Of a pixel's values that are stored multiplied by its alpha. Where that is 0 they stay.
void divide_by_alpha(std::uint8_t* values, int count, int alpha);
// Warns that some pixels are not what was meant.
void warn_of_damage(const std::string& name);
// Warns of so many channels, if any, that are no transparency.
void warn_of_left_out(int channels, const std::string& name);

[[noreturn]] void refuse_picture(const std::string& name, const char* kind, const std::string& why);
// Throws for no pixels, more than 2^15 px a side or 2^28 px in all, and for more than a file of
// that many bytes can hold.
void check_picture_size(const std::string& name, const char* kind, std::uint32_t width,
                        std::uint32_t height, double smallest_file_bytes, std::size_t file_bytes);

}  // namespace hydrodip
