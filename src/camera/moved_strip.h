// Whether a strip of the rim lies elsewhere than it was calibrated, as the others tell.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "camera/view_finder.h"

namespace hydrodip {

struct MovedStrip {
  int strip = 0;
  double moved_mm = 0, sigma_mm = 0;  // of the corner that has moved farthest
  double others_px = 0;               // what the rest of the rim then fits to

  // By more than calibrations and this photo leave in doubt.
  bool is_sure() const;
};

// The strip without which all others fit best: corner by corner one that has moved as a whole is
// not found, as the view gives way to it. `from`: a view that is near. None: no strip can be done
// without.
std::optional<MovedStrip> most_moved(const RimCorners& corners, const ViewFinder& finder,
                                     const Eigen::VectorXd& from);

}  // namespace hydrodip
