// Where the stage was to be and where it said it was, over time.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydrodip {

struct TracePoint {
  std::string phase;  // "dip"
  double time_s = 0;  // since the first point
  double commanded_mm = 0;
  double reported_mm = 0;
};

using Trace = std::vector<TracePoint>;

// Of a phase at constant speed.
struct SpeedCheck {
  double commanded_mm_per_min = 0;
  double measured_mm_per_min = 0;  // slope of the reported positions between 10 and 90 % of the way
  double largest_deviation_mm = 0;  // of reported from commanded
  double error_percent() const { return 100 * (measured_mm_per_min / commanded_mm_per_min - 1); }
};

// Nothing if the phase has too few points to tell.
std::optional<SpeedCheck> check_speed(const Trace& trace, const std::string& phase,
                                      double commanded_mm_per_min);

// phase,time_s,commanded_mm,reported_mm
std::string trace_csv(const Trace& trace);
// A small plot of both over time, lower places lower, phases marked.
std::string trace_svg(const Trace& trace, bool down_is_plus);

}  // namespace hydrodip
