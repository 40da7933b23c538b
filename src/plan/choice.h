// Which dips to make when several share an object: poses chosen together.
#pragma once

#include <vector>

#include "plan/targets.h"
#include "plan/trial.h"

namespace hydrodip {

struct ChoiceOptions {
  int dips = 2;
  std::vector<Trial> kept;  // dips that are given, and count first; at most `dips` of them
  bool better = true;       // try poses like the chosen ones
};

struct ChosenDips {
  std::vector<Trial> dips;  // the kept ones first and as given; then in the order of what each adds
  std::vector<Trial> tried;  // poses like them that were tried, all of them
};

// Share of the surface that is under whole film of at least one of them.
double covered_share_of(const Targets& targets, const std::vector<const Trial*>& dips);

// From many beginnings, by exchanging one for another as long as that helps, and again with poses
// like those that were chosen. What counts most is that a place is reached at all, and less how
// well. `trials` and `task` are a search's, with the torn price of one among several in both.
// Deterministic for any number of threads.
ChosenDips choose_dips(const TrialTask& task, const std::vector<Trial>& trials,
                       const ChoiceOptions& options, const RunContext& context);

}  // namespace hydrodip
