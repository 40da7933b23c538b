#include "studio/receive_file.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "studio/api_error.h"
#include "studio/dropped_files.h"

namespace hydrodip {

void receive_file(HttpRequest& request, const std::filesystem::path& file,
                  std::uintmax_t most_bytes) {
  const auto too_large = [] {
    return ApiError(413, "too-large",
                    fmt::format("A file may have {} MB, and all files of a job {} MB.",
                                kMostFileBytes >> 20U, kMostJobBytes >> 20U));
  };
  if (request.body_bytes.value_or(0) > most_bytes) throw too_large();
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wb"),
                                                            std::fclose);
  if (!out) throw ApiError(500, "failed", "The file cannot be kept; free some space.");
  std::uintmax_t bytes = 0;
  bool fits = true, kept = true;
  const bool whole = request.read_body([&](const char* data, std::size_t size) {
    bytes += size;
    fits = bytes <= most_bytes;
    kept = fits && std::fwrite(data, 1, size, out.get()) == size;
    return kept;
  });
  if (!fits) throw too_large();
  kept = kept && std::fflush(out.get()) == 0;
  if (!kept) throw ApiError(500, "failed", "The file cannot be kept; free some space.");
  if (!whole) throw ApiError(400, "bad-request", "The file did not come whole.");
}

}  // namespace hydrodip
