// A guided dip's log, read back.
#pragma once

#include <filesystem>
#include <optional>

#include "history/history.h"

namespace hydrodip {

// What JOB/rig-N/log.jsonl says. Nothing for runs that only moved the stage. A line that is broken
// (the computer went off while it was written) is left out.
std::optional<DipRun> read_run_log(const std::filesystem::path& run_folder);

// Whether the log says what the run is about; an empty or damaged one does not.
bool is_begun_log(const std::filesystem::path& run_folder);

}  // namespace hydrodip
