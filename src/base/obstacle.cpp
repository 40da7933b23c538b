#include "base/obstacle.h"

#include <system_error>

namespace hydrodip {

std::string obstacle_at(const std::filesystem::path& path) {
  std::error_code ignored;
  switch (std::filesystem::status(path, ignored).type()) {
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return "a device";
    case std::filesystem::file_type::fifo:
      return "a pipe";
    case std::filesystem::file_type::socket:
      return "a socket";
    default:
      return "";
  }
}

std::string why_absent(const std::filesystem::path& folder, const std::string& name) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder, ignored)) return "there is no such folder";
  if (!std::filesystem::is_directory(folder, ignored)) return "it is a file, not a folder";
  return "there is no " + name + " in it";
}

}  // namespace hydrodip
