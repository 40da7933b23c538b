// The [[dip]] tables of a job file: one for each of several dips.
#pragma once

#include <functional>

#include "settings/params.h"
#include "transfer/allotment.h"

namespace hydrodip {

// The names of a table's values.
const std::vector<std::string>& dip_keys();

// "dip[2].depth_mm": a value of the job's second dip, which is made if it is new. False for any
// other name. Throws InputError for unknown keys and wrong values.
bool apply_dip_setting(JobConfig& config, const Setting& setting);

// A way in as TOML has it: [[0, 0, 0, 0, 0, 0], ...].
std::string path_text(const std::vector<Keyframe>& path);

// The dips as [[dip]] tables; `correction_text` says a correction's file as TOML has it.
std::string dip_tables_toml(
    const std::vector<DipEntry>& dips,
    const std::function<std::string(const std::filesystem::path&)>& correction_text);

}  // namespace hydrodip
