// Many runs of one job with other values each: which, told by a file.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/context.h"
#include "settings/config.h"
#include "sweep/sweep_command.h"

namespace hydrodip {

struct SweepRun {
  std::string id;     // 16 hexadecimal digits: a hash of command, values and all files it reads
  std::string model;  // relative to the sweep's folder, or absolute; empty: the job's own
  // Parameter, value as for --set; files as `model`.
  std::vector<std::pair<std::string, std::string>> values;
};

struct SweepPlan {
  SweepCommand command = SweepCommand::kSimulate;
  std::string quality;              // as --quality
  std::string job;                  // a job's or configuration's file; may be empty
  bool keep_files = false;          // all that a run writes, not its report alone
  std::vector<std::string> varied;  // names of what differs between the runs, "model" among them
  std::vector<SweepRun> runs;       // no two with the same id
  std::size_t same = 0;             // runs that were left out, as they are the same as others
  // Files that runs read, as `SweepRun::model`, with their SHA-256; "": there was none.
  std::map<std::string, std::string> inputs;
  // What a model's file names: itself and the files beside it that it refers to.
  std::map<std::string, std::vector<std::string>> model_files;
};

// Reads a sweep's file:
//
//   [sweep]
//   command = "simulate"       # or "print", "orient"
//   method = "grid"            # every combination; or "list", "latin"
//   runs = 100                 # of latin
//   seed = 1                   # of latin
//   quality = "draft"          # draft, normal, fine
//   job = "mask.toml"          # what holds for all; a job or a configuration
//   models = ["a.obj", "b.stl"]
//   keep = "report"            # or "all": every file of every run
//
//   [set]                      # what holds for all, too
//   "film.margin_mm" = 12
//
//   [vary]                     # of grid and latin
//   "material.z_stretch" = [0.4, 0.5, 0.65]
//   "dip.depth_mm" = { from = 5, to = 20, count = 4 }    # grid; log = true: by equal factors
//   "object.rotate_deg" = [[0, 0, 0], [90, 0, 0]]
//
//   [[run]]                    # of list: one after the other
//   model = "c.obj"
//   "dip.depth_mm" = 7       # in place of what [set] has
//
// File names are relative to the sweep's file; in the plan they are relative to `folder`. Every
// run's values are checked as a job's are. Throws InputError with file and place, Cancelled.
SweepPlan read_sweep(const std::filesystem::path& file, const std::filesystem::path& folder,
                     const RunContext& context);

// What the run has for a varied parameter, or "model". Empty: nothing, so the default.
std::string value_of(const SweepRun& run, const std::string& name);

// The configuration of one run; `folder` as above. Throws InputError if a file is gone, or two
// things name the model.
JobConfig sweep_config(const SweepPlan& plan, const SweepRun& run,
                       const std::filesystem::path& folder);

}  // namespace hydrodip
