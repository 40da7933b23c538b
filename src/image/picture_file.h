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

// Dots per inch that a scanner recorded, TIFF's too; 0 when there is none, or if both axes differ.
double scan_dpi(const std::vector<std::uint8_t>& bytes);

// TIFF's alone.
double recorded_tiff_dpi(const std::vector<std::uint8_t>& bytes);

}  // namespace hydrodip
