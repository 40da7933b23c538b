// Picture files, looked at before they are read whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace hydrodip {

// A picture's bytes, for decode_image. Throws InputError, as read_file and decode_image do, after
// its first bytes if no picture of a kind that is read begins like that, and for files larger than
// any picture that is decoded.
std::vector<std::uint8_t> read_picture(const std::filesystem::path& path);

// Dots per inch; 0 when a file does not say them.
struct Resolution {
  double across_dpi = 0, along_dpi = 0;
  bool is_one() const { return across_dpi == along_dpi; }  // for both directions
};

// As a PNG, JPEG (JFIF or EXIF) or TIFF records it.
Resolution recorded_resolution(const std::vector<std::uint8_t>& bytes);
// Of files of one kind.
Resolution png_resolution(const std::vector<std::uint8_t>& bytes);
Resolution jpeg_resolution(const std::vector<std::uint8_t>& bytes);
Resolution tiff_resolution(const std::vector<std::uint8_t>& bytes);

// That of a scan; 0 when there is none, or if both directions differ.
double scan_dpi(const std::vector<std::uint8_t>& bytes);

}  // namespace hydrodip
