#include "job/job_progress.h"

#include <algorithm>

namespace hydrodip {
namespace {

// Nobody knows how often a step comes again, as a dip with each round of ink: each time it has this
// share of what is left of it. Most jobs of several rounds have four to eight.
constexpr double kShareOfRest = 1.0 / 3;
// Before that, an estimate would be a guess.
constexpr double kLeastFraction = 0.08, kLeast_s = 0.5;

}  // namespace

// The weights are the share of each step in jobs of the samples and of spot; what a job does not
// have is passed over.
JobProgress::JobProgress(const std::string& command) {
  if (command == "print" || command == "pattern" || command == "nest" || command == "simulate")
    steps_ = {{"loading", 3},
              {"laying artwork", 3},
              {"looking for trapped air", 4},
              {"dipping", 45},
              {"writing the sheet", 15},
              {"drawing the previews", 25},
              {"drawing the run sheets", 5}};
  else if (command == "orient")
    steps_ = {{"loading", 3}, {"trying", 60}, {"dipping the best", 25}, {"drawing", 12}};
  else if (command == "plan")
    steps_ = {{"loading", 3},       {"dipping what is given", 5},
              {"trying", 55},       {"trying poses like", 10},
              {"dipping them", 17}, {"drawing", 10}};
}

void JobProgress::update(const std::string& activity, double fraction) {
  double before = 0;
  const Step* step = nullptr;
  double start = 0;
  for (const Step& s : steps_) {
    // The longest beginning counts.
    if (activity.starts_with(s.activity) && (!step || s.activity.size() > step->activity.size())) {
      step = &s;
      start = before;
    }
    before += s.weight;
  }
  if (!step) return;
  if (step->activity != step_) {
    step_ = step->activity;
    done_ = 0;
  } else if (fraction < last_) {
    done_ += (1 - done_) * kShareOfRest;
  }
  last_ = fraction;
  const double own = done_ + (1 - done_) * kShareOfRest * fraction;
  fraction_ = std::max(fraction_, (start + step->weight * own) / before);
}

double JobProgress::left_s(double elapsed_s) const {
  if (fraction_ < kLeastFraction || elapsed_s < kLeast_s) return -1;
  return elapsed_s * (1 - fraction_) / fraction_;
}

}  // namespace hydrodip
