// Files that are never large, refused before they are read if they are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hydrodip {

// As read_file; throws InputError, too, for a file of more bytes. `what`: "a correction".
std::vector<std::uint8_t> read_small_file(const std::filesystem::path& path,
                                          std::uintmax_t most_bytes, const std::string& what);

}  // namespace hydrodip
