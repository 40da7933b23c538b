#include "base/small_file.h"

#include <fmt/format.h>

#include <system_error>

#include "base/error.h"
#include "base/file.h"

namespace hydrodip {

std::vector<std::uint8_t> read_small_file(const std::filesystem::path& path,
                                          std::uintmax_t most_bytes, const std::string& what) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) {
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > most_bytes)
      throw InputError(fmt::format("{}: has {:.1f} MB, too many for {}; check which file it is.",
                                   path.string(), double(size) / 1e6, what));
  }
  return read_file(path);
}

}  // namespace hydrodip
