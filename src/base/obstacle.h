// What stands where a file is to be written, or where one was looked for.
#pragma once

#include <filesystem>
#include <string>

namespace hydrodip {

// "a folder", "a device", "a pipe", "a socket"; empty for a file, for a link to one, and where
// there is nothing. Writing a file there would replace it, or wait for a reader.
std::string obstacle_at(const std::filesystem::path& path);

// Why there is no file of that name in the folder: "there is no such folder", "it is a file, not a
// folder", "there is no report.json in it".
std::string why_absent(const std::filesystem::path& folder, const std::string& name);

}  // namespace hydrodip
