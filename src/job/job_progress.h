// How far a job is as a whole, and how long it will still take.
#pragma once

#include <string>
#include <vector>

namespace hydrodip {

// From what the job's activities say of themselves. Rises only.
class JobProgress {
 public:
  // `command` as the command line names it. Of one that is not known here nothing is told.
  explicit JobProgress(const std::string& command);

  // `fraction` of the activity, which may come again.
  void update(const std::string& activity, double fraction);

  // Of the job; 0: unknown yet, or for good.
  double fraction() const { return fraction_; }
  // What it will still take; negative: that cannot be told yet.
  double left_s(double elapsed_s) const;

 private:
  struct Step {
    std::string activity;  // begins with
    double weight;
  };
  std::vector<Step> steps_;
  std::string step_;
  double last_ = 0;  // of the present step
  double done_ = 0;  // of it, when it last began again
  double fraction_ = 0;
};

}  // namespace hydrodip
