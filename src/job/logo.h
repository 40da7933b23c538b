// The picture above a report page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace hydrodip {

// As a PNG file's bytes, no larger than a page shows it; empty without a file. Throws InputError if
// it cannot be read.
std::vector<std::uint8_t> logo_png(const std::filesystem::path& file);

}  // namespace hydrodip
