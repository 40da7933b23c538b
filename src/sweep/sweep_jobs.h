// The commands behind `hydrodip sweep`.
#pragma once

#include <filesystem>
#include <string>

#include "job/jobs.h"
#include "sweep/sweep_run.h"

namespace hydrodip {

struct SweepPlanRequest {
  std::filesystem::path file;
  std::filesystem::path folder;
  bool trial = true;         // does the first run, to know that it works and how long one takes
  int tasks = 0;             // of a cluster's array; 0: so many that each lasts some minutes
  std::string version = {};  // as SweepWork::version
};

// Writes FOLDER/sweep.json, and scripts that give the runs to GNU parallel and to Slurm. A sweep
// that is planned again keeps the outcomes of runs that are the same.
JobResult sweep_plan_job(const SweepPlanRequest& request, const RunContext& context);

JobResult sweep_run_job(const std::filesystem::path& folder, const SweepWork& work,
                        const RunContext& context);

// FOLDER/table.csv, table.json, and response.svg if a number was varied; whatever is there so far.
JobResult sweep_collect_job(const std::filesystem::path& folder, const RunContext& context);

}  // namespace hydrodip
