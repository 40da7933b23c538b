// What a simulated film lacks for being cut into triangles, and finer films.
#pragma once

#include <Eigen/Core>

#include "coat/design.h"

namespace hydrodip {

// Cells half as wide, steps half as high.
DesignOptions finer_film(const DesignOptions& design);

// What to add to misfits on a film, up to the continuum, and by how much that may be wrong, all
// together. Empty: nothing.
struct Correction {
  Eigen::VectorXd all, doubt;
};

// From how misfits change on finer_film(). What they still change by from there on follows from
// that, if errors fall as the square of the cells' size (Richardson); they may fall only as the
// size itself: the doubt.
Correction correction(const Eigen::VectorXd& change);

}  // namespace hydrodip
