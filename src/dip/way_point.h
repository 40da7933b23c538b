// A moment of a way into the water, for those who have to go it.
#pragma once

#include "dip/trajectory.h"

namespace hydrodip {

// Where the object is then, and how far its fastest wetted point has come.
struct WayPoint {
  double travelled_mm = 0;
  Keyframe pose;
};

}  // namespace hydrodip
