// A configuration, or some of its values, as a file to read back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "settings/config.h"

namespace hydrodip {

// TOML that sets everything in which the configuration differs from the defaults, its model, its
// artwork and its dips, to be written into `folder`: files that it names are given from there.
std::string job_file(const JobConfig& config, const std::filesystem::path& folder);

// TOML that sets the parameters of these names to the configuration's values. Named files are given
// as absolute paths: who reads it may be anywhere.
std::string settings_file(const JobConfig& config, const std::vector<std::string>& names);

}  // namespace hydrodip
