// A sweep's plan as FOLDER/sweep.json has it.
#pragma once

#include <filesystem>
#include <string>

#include "sweep/sweep_plan.h"

namespace hydrodip {

std::string manifest_json(const SweepPlan& plan);
// Throws InputError if there is none, or it is of another kind or version.
SweepPlan read_manifest(const std::filesystem::path& folder);

}  // namespace hydrodip
