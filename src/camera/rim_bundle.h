// All photos of an empty tank together (a bundle adjustment): which corners of the rim's strips
// they show, and the lens, camera poses and strips' poses that agree with them best.
#pragma once

#include <vector>

#include "camera/least_squares.h"
#include "camera/lens.h"
#include "camera/planar_motion.h"

namespace hydrodip {

struct RimObservation {
  int photo = 0, strip = 0;  // numbers in RimBundle
  int tag = 0;
  Vec2 on_strip = Vec2::Zero(), px = Vec2::Zero();
};

struct RimBundle {
  int photos = 0, strips = 0;  // strip 0 is the one that all others refer to
  Vec2 middle_px = Vec2::Zero();
  std::vector<RimObservation> seen;
};

// Cameras: from the frame of strip 0 to theirs. Strips: from their frames to that of strip 0, which
// comes first and lies where it lies.
struct RimUnknowns {
  Lens lens;
  std::vector<Pose> cameras, strips;
};

// From a guess of lens and cameras, and of how the strips lie in the plane of strip 0. Corners that
// belong to nothing are taken out of the bundle.
struct RimSolution {
  RimUnknowns unknowns;
  Fit fit;  // the lens's values come first
};
RimSolution solve(RimBundle& bundle, const RimUnknowns& start,
                  const std::vector<PlanarMotion>& planar);

}  // namespace hydrodip
