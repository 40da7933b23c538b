// Which dips to make when several share an object: poses chosen together.
#pragma once

#include <vector>

#include "plan/search.h"

namespace hydrodip {

struct ChoiceOptions {
  int dips = 2;
  std::vector<Trial> kept;  // dips that are given, and count first; at most `dips` of them
  bool better = true;       // try poses like the chosen ones
};

// Share of the surface that is under whole film of at least one of them.
double covered_share_of(const Targets& targets, const std::vector<const Trial*>& dips);

// Greedily, then by exchanging one for another as long as that helps, then by trying poses like
// each of them. What counts most is that a place is reached at all, and less how well. The kept
// ones first and as given; the others in the order in which each adds most. `trials` and `task` are
// a search's, with the torn price of one among several in both.
std::vector<Trial> choose_dips(const TrialTask& task, const std::vector<Trial>& trials,
                               const ChoiceOptions& options, const RunContext& context);

}  // namespace hydrodip
