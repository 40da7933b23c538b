// What the dipped film is measured by: area ratios, stretch, tears.
#pragma once

#include "dip/scheme.h"

namespace hydrodip {

// The result of a dip from its last state. Triangles on the object that are stretched beyond
// material.tear_stretch count as torn too.
DippedFilm measured(const FilmMesh& film, const DipState& state, const DipOptions& options);

}  // namespace hydrodip
