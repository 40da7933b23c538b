// A configuration as a job file.
#pragma once

#include <filesystem>
#include <string>

#include "settings/config.h"

namespace hydrodip {

// TOML that sets everything in which the configuration differs from the defaults, its model, its
// artwork and its dips, to be written into `folder`: files that it names are given from there.
std::string job_file(const JobConfig& config, const std::filesystem::path& folder);

}  // namespace hydrodip
