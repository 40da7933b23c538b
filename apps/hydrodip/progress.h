// Shows progress on stderr: one line that updates itself on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace hydrodip {

class ProgressLine {
 public:
  explicit ProgressLine(bool terminal);
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

  bool terminal_;
  bool drawn_ = false;
  std::string activity_;
  int tenths_shown_ = -1;  // of the activity, in plain lines
  Clock::time_point job_start_;
  Clock::time_point activity_start_;
  Clock::time_point last_draw_;
};

}  // namespace hydrodip
