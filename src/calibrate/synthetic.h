// Scans computed from known parameters, to try everything on that needs scans.
#pragma once

#include <cstdint>

#include "scan/registration.h"

namespace hydrodip {

struct SyntheticOptions {
  double noise_mm = 0;       // standard deviation of each coordinate of each corner
  double missing_share = 0;  // of the corners, left out at random
  std::uint64_t seed = 1;    // of noise, gaps and pose
  bool aligned = false;      // stay in the posed-object frame; else in a random one
};

// The corners that a dip laid on the object, as a scanner would find them; places are the film's
// own. The same for the same seed on every machine.
CornerGrid synthetic_scan(const GridLanding& landing, const GridPlace& reach,
                          const SyntheticOptions& options);

}  // namespace hydrodip
