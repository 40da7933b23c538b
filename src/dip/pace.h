// How long the next step is: as long as the film's strain and the contact line change evenly.
#pragma once

#include <optional>
#include <vector>

#include "dip/feet.h"
#include "dip/scheme.h"

namespace hydrodip {

// All lengths and places on the way are of the fastest wetted point's travel (Travel).
class Pace {
 public:
  explicit Pace(const DipSetting& setting);

  // Where the next step ends, on the way from at_mm to to_mm, which lies not beyond the whole way's
  // end; nothing if the way is as good as gone: what is left of it is gone in the next. Steps that
  // grow may end beyond to_mm.
  std::optional<double> next_end_mm(double at_mm, double to_mm) const;
  // To be called after each step, which began at from_mm; `torn`: whether film has ever torn.
  void see(const Feet& feet, bool torn, double from_mm, double at_mm);

 private:
  bool grows() const { return longest_mm_ > step_mm_; }
  double shortest_mm() const;
  double longest_now_mm(double at_mm) const;
  std::optional<double> next_jump_mm(double at_mm, double end_mm) const;

  double step_mm_, length_mm_, longest_mm_;
  std::vector<double> told_mm_;    // where steps end; empty: not told
  std::vector<double> jumps_mm_;   // where the contact line jumps, ascending
  std::vector<double> lowest_mm_;  // where the water comes to a lowest place, ascending
  double pace_mm_ = 0;             // as long as what was seen allows
};

}  // namespace hydrodip
