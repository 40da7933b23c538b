// Parameters that a sweep varies, and the combinations of their values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/context.h"
#include "sweep/sweep_file.h"

namespace hydrodip {

// Parameters and their values as for --set: what one run has of its own.
using RunValues = std::vector<std::pair<std::string, std::string>>;

// What [vary] says, every combination of it; the last parameter changes fastest. Files are named as
// from `folder`. Throws InputError, Cancelled.
std::vector<RunValues> grid_runs(const SweepFile& file, const std::filesystem::path& folder,
                                 const RunContext& context);

// A latin hypercube: each parameter's values are cut into as many parts as there are runs, and each
// part is used once. The same on every machine. Throws InputError.
std::vector<RunValues> latin_runs(const SweepFile& file, const std::filesystem::path& folder,
                                  std::size_t runs, std::uint64_t seed);

}  // namespace hydrodip
