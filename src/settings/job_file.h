// A configuration, or some of its values, as a file to read back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "settings/config.h"

namespace hydrodip {

// TOML that sets everything in which the configuration differs from the defaults, its model, its
// artwork and its dips, to be written into `folder`: files that it names are given from there. Of
// what belongs to a run (run, output) only the parameters that are named.
std::string job_file(const JobConfig& config, const std::filesystem::path& folder,
                     const std::vector<std::string>& of_the_run = {});

// TOML that sets the parameters of these names to the configuration's values. Named files are given
// as absolute paths: who reads it may be anywhere.
std::string settings_file(const JobConfig& config, const std::vector<std::string>& names);

}  // namespace hydrodip
