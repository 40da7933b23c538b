// One view of the object in a small photo studio: a plain curved backdrop, a soft lamp from above
// left, a white sky. Light and visibility are worked out once and both appearances shown in it.
#pragma once

#include <vector>

#include "base/context.h"
#include "report/appearance.h"
#include "report/normals.h"
#include "report/view.h"

namespace hydrodip {

struct Studio {
  const Object& object;
  const Surface& surface;
  const std::vector<CornerNormals>& normals;
  const Appearance& appearance;
  int samples_per_axis = 3;
  // 0: lit as in the studio; 1: no light and shade at all, colours are shown as they are. Maps,
  // whose colours are to be read off, lie between.
  double flatness = 0;
};

struct ViewPair {
  Image wanted;
  Image predicted;
};

// Renders the view of `camera` at the given size. The result does not depend on the number of
// threads. Throws Cancelled when the job was cancelled.
ViewPair render_view(const Studio& studio, const Camera& camera, int width_px, int height_px,
                     RunContext& context);

}  // namespace hydrodip
