// What depends on how torn film falls, which nobody knows.
#pragma once

#include <vector>

#include "dip/dip.h"

namespace hydrodip {

// Steps so long take a sixth of the time, and film lies nearly where it does in the dip's own.
double longer_step_mm(double step_mm);

// How far the object had travelled when film first let go; infinity: none did.
double first_let_go_mm(const DippedFilm& dipped);

// Per vertex of the film: how far from where it was dipped it may lie, mm: the farther of where it
// lies if floating film lets go as soon as it may tear (material.safe_stretch), and if it holds as
// long as any film could (lost_stretch). From dips of the same film in longer steps. The other
// arguments are those of the dip that asks; the way may end earlier than its own, for what lay on
// the object by then. If its own steps are long already it is compared with, and the way should be
// a whole number of them. Straight down, what lay on the object before film let go does not move:
// it is as certain as in a dip that ends there.
std::vector<double> moved_by_tears(const DippedFilm& dipped, const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles, const Surface& surface,
                                   const Trajectory& trajectory, const DipOptions& options,
                                   const RunContext& context);

}  // namespace hydrodip
