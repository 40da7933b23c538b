// A request's body, written to a file as it comes.
#pragma once

#include <cstdint>
#include <filesystem>

#include "studio/http.h"

namespace hydrodip {

// Throws ApiError if it has more bytes, does not come whole, or finds no room on the disk;
// something of the file may be there then.
void receive_file(HttpRequest& request, const std::filesystem::path& file,
                  std::uintmax_t most_bytes);

}  // namespace hydrodip
