// Where a dip finds its film in the next step, by what the dip before it found there: two dips in
// the same steps, of film that differs by little, find nearly the same. To begin there saves
// iterations, and changes what is found by no more than the equilibrium's tolerance.
#pragma once

#include <cstddef>
#include <vector>

#include "elastic/film_grid.h"

namespace hydrodip {

// Of one dip: how far from flat its film relaxed in every step, in film coordinates.
struct RelaxedSteps {
  std::vector<double> ends_mm;
  std::vector<float> ways;  // of each step: x all over the grid, then y
};

class Foresight {
 public:
  // Reads what the dip before kept in `steps` and keeps what this one finds in its place; null:
  // neither. Refers to all of them. `flat`: film coordinates of film that does not move.
  Foresight(const GridLayout& layout, const GridField& flat, RelaxedSteps* steps);

  // Before film relaxes in the next step, which ends there: brings it from where it relaxed in the
  // last one to where the dip before had it now, and on by as much as it was further on last time.
  // Leaves it where that dip went in other steps.
  void foresee(double end_mm, GridField& film);
  // Once it has relaxed.
  void keep(const GridField& film);

 private:
  bool is_known() const { return steps_ && now_ < steps_->ends_mm.size(); }
  // Of the step at hand: x, followed by y.
  float* way() const { return steps_->ways.data() + now_ * per_step_; }
  void forget_from_now_on();

  const GridField& flat_;
  RelaxedSteps* steps_;
  const std::size_t entries_, per_step_;
  std::size_t now_ = 0;  // the step at hand
  double end_mm_ = 0;    // of it
  GridField further_;    // than the dip before, in the last step
};

}  // namespace hydrodip
