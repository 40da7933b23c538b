// Answers that are no JSON: files, packed bytes, and the page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "studio/http.h"

namespace hydrodip {

// What never changes under its address. Null: throws ApiError not-found.
HttpAnswer bytes_answer(std::shared_ptr<const std::vector<std::uint8_t>> bytes,
                        const std::string& type = "application/octet-stream");

// A file of a job, of which scripts get no hold of this address; `save_as`: what a browser calls it
// that keeps it. Throws ApiError not-found.
HttpAnswer file_answer(const std::filesystem::path& file, const std::string& save_as = "");

// A folder's file of that name, which may be "dip-1/print.pdf" and never lies elsewhere. Throws
// ApiError bad-name, not-found.
std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& name);

// A file of the page: as it was built in, or for work on it that of $HYDRODIP_STUDIO_PAGE.
HttpAnswer page_answer(const std::string& type, const std::string& name,
                       const std::string& built_in);

}  // namespace hydrodip
