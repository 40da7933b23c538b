// What stands where a file is to be written.
#pragma once

#include <filesystem>
#include <string>

namespace hydrodip {

// "a folder", "a device", "a pipe", "a socket"; empty for a file, for a link to one, and where
// there is nothing. Writing a file there would replace it, or wait for a reader.
std::string obstacle_at(const std::filesystem::path& path);

}  // namespace hydrodip
