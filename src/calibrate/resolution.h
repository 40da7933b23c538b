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

// From the same misfits on that film and on finer_film() of it. What they still change by from
// there on follows from how they changed, if errors fall as the square of the cells' size
// (Richardson). Where ink is stiff and edges are sharp, they may fall only as the size itself
// (docs/calibration.md): the doubt.
Correction correction(const Eigen::VectorXd& here, const Eigen::VectorXd& finer);

}  // namespace hydrodip
