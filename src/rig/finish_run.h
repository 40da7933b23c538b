// The end of every run at the bench, good or bad: the log says what happened, the trace is kept.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "job/jobs.h"
#include "rig/mover.h"
#include "rig/run_record.h"

namespace hydrodip {

struct RunEnd {
  std::string step;  // where it ended
  Trace trace;
  std::optional<Rest> rest;  // of a movement that was broken off
  bool guided = false;
};

// Runs it, writes the log's last line and the run's files, and passes on what was thrown (Cancelled
// with the place of the log added). `command`: "rig guide".
JobResult finish_run(RunRecord& record, const std::string& command,
                     const std::function<void()>& run, const std::function<RunEnd()>& end);

}  // namespace hydrodip
