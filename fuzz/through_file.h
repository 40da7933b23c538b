// For readers that take a path: the bytes as a file in memory.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace hydrodip::fuzz {

// A folder of this process, in memory where there is such a place.
inline std::filesystem::path file_with(const char* name, const std::uint8_t* data,
                                       std::size_t size) {
  static const std::filesystem::path folder = [] {
    std::string text = "/dev/shm/fuzz-XXXXXX";
    if (!mkdtemp(text.data())) std::abort();
    return std::filesystem::path(text);
  }();
  const std::filesystem::path path = folder / name;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) std::abort();
  return path;
}

}  // namespace hydrodip::fuzz
