// The folder in which a result lies until it is whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace hydrodip {

inline constexpr std::string_view kStagingPrefix = ".hydrodip-";
inline constexpr std::string_view kStagingLetters = "XXXXXX";  // for mkdtemp

inline bool is_staging_name(std::string_view name) {
  return name.starts_with(kStagingPrefix) &&
         name.size() == kStagingPrefix.size() + kStagingLetters.size();
}

// Where a file of it will be, which is what people know it by. Any other stays as it is.
inline std::filesystem::path final_path(const std::filesystem::path& path) {
  std::filesystem::path result;
  bool is_staged = false;
  for (const std::filesystem::path& part : path) {
    const bool is_staging = is_staging_name(part.native());
    is_staged = is_staged || is_staging;
    if (!is_staging) result /= part;
  }
  return is_staged ? result : path;
}

}  // namespace hydrodip
