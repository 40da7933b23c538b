// What the dipped film is measured by: area ratios, stretch, tears.
#pragma once

#include "dip/scheme.h"

namespace hydrodip {

// The result of a dip from its last state. Film on the object that is stretched beyond
// material.tear_stretch is torn, inside triangles too (DippedFilm::excess). Triangles that lie
// upside down are torn as well: film folded over itself or spanned between parts of the object
// prints nothing where it should.
DippedFilm measured(const SharedFilmMesh& mesh, const DipState& state, const DipOptions& options,
                    const Surface& surface);

// Adds how far film lies elsewhere if torn film falls another way, and tears off what depends on
// that.
void add_moved(std::vector<double> moved_mm, const DipOptions& options, DippedFilm& film);

// The principal stretch beyond which floating film lets go without being told to: in the middle
// between where it may tear and where no film holds, so that it lies as near as can be to where it
// lies in either case; 0: never.
double let_go_limit(const DipOptions& options);

}  // namespace hydrodip
