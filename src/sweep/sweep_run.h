// Doing the runs of a sweep, here or on many machines that share a file system.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/context.h"
#include "base/error.h"
#include "base/shard.h"
#include "sweep/sweep_plan.h"

namespace hydrodip {

// What became of a run: FOLDER/runs/ID.json, which appears whole or not at all.
struct SweepOutcome {
  std::string error;  // empty: it went well
  double seconds = 0;
  std::string report;  // report.json's text; empty if it failed
  // Of the program that did it, as SweepWork has it; empty: it is not written there.
  std::string version = {};
};
// Nothing, too, if the file is damaged or another run's: the run has to be done again.
std::optional<SweepOutcome> read_outcome(const std::filesystem::path& folder,
                                         const std::string& id);

// The disk is full, which is no run's fault.
class NoRoomForResults : public InputError {
 public:
  using InputError::InputError;
};

struct SweepWork {
  Shard shard;
  std::string id;      // this one only; empty: all of the shard
  bool again = false;  // runs that failed and those that other versions did, too
  // This program's, which outcomes note; empty: none, and nobody asks which did what.
  std::string version = {};
};

struct SweepDone {
  int done = 0, failed = 0;  // now
  int before = 0;            // had an outcome already
  int elsewhere = 0;         // another process was at them
  int changed = 0;           // not done: files that they read are not those that were planned
  std::string what_changed;  // a sentence about the first of these
  // Of those done before, how many which other version of the program did.
  std::map<std::string, int> by_others = {};
};

// "8 by hydrodip 0.1.0, 4 by hydrodip 0.2.0"
std::string told_versions(const std::map<std::string, int>& runs_by_version);

// Does the runs that have no outcome yet, each on one thread, side by side on the context's. No run
// is done twice, whoever else is at it: a lock on FOLDER/claims/ID tells, and goes with its
// process. Where the file system has no locks a warning says so. Throws InputError if the folder
// cannot be written to, NoRoomForResults, Cancelled.
SweepDone run_sweep(const std::filesystem::path& folder, const SweepPlan& plan,
                    const SweepWork& work, const RunContext& context);

}  // namespace hydrodip
