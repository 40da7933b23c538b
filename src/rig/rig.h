// The commands behind `hydrodip rig`.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/context.h"
#include "job/jobs.h"
#include "rig/link.h"
#include "rig/operator.h"
#include "rig/rig_job.h"

namespace hydrodip {

// The run sheet for the wet bench as a PDF of one or two pages; every figure is the job's. `paper`:
// "a4", "letter" or "" (letter for letter film, else A4); `file` empty: FOLDER/run-sheet.pdf.
JobResult rig_sheet(const RigJob& job, const std::string& paper, const std::filesystem::path& file,
                    const RunContext& context);

// Who and what takes part at the bench. `open`: the wire to the stage.
struct Bench {
  Operator& person;
  Clock& clock;
  std::function<std::unique_ptr<Link>(const StageOptions&)> open;
  bool yes_given = false;  // on the command line: do not ask before movements
};

// Leads through a dip step by step; with config.stage.port it moves the stage as well. Writes a
// log and the trace to a new folder JOB/rig-N, whatever happens. Throws Cancelled, StageError,
// InputError, with the log's last line saying the same.
JobResult rig_guide(const RigJob& job, Bench& bench, const RunContext& context);

// action: "status", "home", "jog", "approach", "dip", "retract". Only "status", "home" and "jog"
// can do without a job.
struct StageAction {
  std::string action;
  double jog_mm = 0;  // down is positive
  bool dry_run = false;
};
JobResult rig_stage(const StageAction& action, const RigJob* job, const StageOptions& stage,
                    Bench& bench, const RunContext& context);

// "find": asks at every serial port of this computer, or at the one given.
JobResult rig_find(const StageOptions& stage, Bench& bench, const RunContext& context);

}  // namespace hydrodip
