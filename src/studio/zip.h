// ZIP archives in and out. zip.cpp knows libzip.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace hydrodip {

// Unpacks every file with a plain name (job_files.h) by `place`, which says where it goes, or
// nothing: it is left out. Folders, links and hidden files are left out. Throws InputError for what
// is no archive, or unpacks to more than `most_bytes` or to more than some hundred times itself;
// nothing of it is left then.
void unpack_zip(const std::filesystem::path& archive, std::uintmax_t most_bytes,
                const std::function<std::filesystem::path(const std::string& name)>& place);

// Files under their names in the archive, in that order; bytes depend on them alone.
void pack_zip(const std::filesystem::path& archive,
              const std::vector<std::pair<std::string, std::filesystem::path>>& files);

}  // namespace hydrodip
