// The [[part]] tables of a job whose parts share a sheet: "part[2].count".
#pragma once

#include "settings/params.h"

namespace hydrodip {

inline constexpr std::size_t kMostParts = 100;

// Applies a setting whose name begins with "part[NUMBER]."; false: it is none. Throws InputError
// naming setting, value, what it has to be, and origin.
bool apply_part_setting(JobConfig& config, const Setting& setting);

}  // namespace hydrodip
