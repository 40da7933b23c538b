// Shows progress on stderr: one line that updates itself on a terminal, plain lines elsewhere. How
// far the present activity is, and the whole job where that can be told.
#pragma once

#include <chrono>
#include <string>

#include "job/job_progress.h"

namespace hydrodip {

class ProgressLine {
 public:
  ProgressLine(const std::string& command, bool terminal);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(const std::string& activity, double fraction);
  // Removes the line, before anything else is printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void redraw(double fraction);
  void add_line(double fraction);
  std::string describe(double fraction) const;
  // How long is left of the job, or at least of the activity; negative: that cannot be told yet.
  double left_s(double fraction) const;

  bool terminal_;
  JobProgress job_;
  bool drawn_ = false;
  std::string activity_;
  int tenths_shown_ = -1;  // of the activity, in plain lines
  Clock::time_point job_start_;
  Clock::time_point activity_start_;
  Clock::time_point last_draw_;
};

}  // namespace hydrodip
