// How far scanned corners lie from where a simulated dip lays them, and what of that nobody has
// measured.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibrate/landings.h"

namespace hydrodip {

// Three rows for each of `corners`: by what the positions of these corners move if the scan or the
// film is moved, a column for each way in which that can be: the scan's pose (6), the film's place
// and turn against the object (3), and ink that spreads, so that dark squares come out larger (1;
// nothing where dark squares meet at their corners). Nobody knows these, so a comparison leaves
// them out. NaN for a corner that has no landing.
// `pose_known`: the scan is in the object's frame already.
Eigen::MatrixXd open_motions(const Board& board, const Landings& landings,
                             const std::vector<GridPlace>& corners, bool pose_known = false);

// Columns of the same space that are at right angles to each other and of length 1.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

// What is left of the columns at right angles to an orthonormal space.
Eigen::MatrixXd without(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& space);

}  // namespace hydrodip
