// The best ways to hold an object, found by dipping it.
#pragma once

#include <functional>
#include <vector>

#include "base/context.h"
#include "plan/trial.h"

namespace hydrodip {

struct SearchOptions {
  int best = 3;         // how many ways to hold it are wanted
  int directions = 74;  // tried before the best of them are bettered
  int refined = 4;      // so many of them, that far apart at least; 0: none are bettered
  double apart_deg = 30;
  int first_elements = 5000;  // of the film in which the directions are tried
  bool confirm = true;        // dip the best as finely as the job
};

// The job's dip may go deeper than its trial by that much.
inline constexpr double kDeeper_mm = 3;

// A shorter search, for a word of advice.
SearchOptions quick_search();

struct SearchResult {
  std::vector<Trial> best;    // first, apart from each other; by the job's dip where it confirms
  std::vector<Trial> trials;  // all trial dips, in the order in which they were made
};

// `task.dip` and `task.film` as the job has them: trial dips are coarser. Sees the best so far
// after each round of trials. The pose's size and side down are kept, and its rotation replaced.
// Deterministic for any number of threads. Throws InputError if the object fits film and bath in no
// pose that was tried.
SearchResult search_holds(const TrialTask& task, const PoseOptions& pose,
                          const SearchOptions& options, const RunContext& context,
                          const std::function<void(const Trial& best)>& watch = {});

// The job's dip, coarser: as trial dips are made.
TrialTask trial_task(TrialTask task);

// Tries poses side by side, each on one thread. One result a pose; nothing where it does not fit.
// `worth_asking`: per pose, instead of the task's; empty: the task's.
std::vector<std::optional<Trial>> try_poses(const TrialTask& task,
                                            const std::vector<PoseOptions>& poses,
                                            const RunContext& context,
                                            const std::vector<double>& worth_asking = {});

// Angle between the directions that point down.
double angle_between_deg(const PoseOptions& a, const PoseOptions& b);

}  // namespace hydrodip
