// What the dipped film is measured by: area ratios, stretch, tears.
#pragma once

#include "dip/scheme.h"

namespace hydrodip {

// The result of a dip from its last state. Triangles on the object that are stretched beyond
// material.tear_stretch count as torn too, and so do those that lie upside down: film folded over
// itself or spanned between parts of the object prints nothing where it should.
DippedFilm measured(const SharedFilmMesh& mesh, const DipState& state, const DipOptions& options,
                    const Surface& surface);

// The principal stretch at which film tears without being told to; 0: never.
double tear_limit(const DipOptions& options);

}  // namespace hydrodip
