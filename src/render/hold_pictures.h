// Ways to hold an object, side by side: how it hangs, and what the film covers.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/context.h"
#include "image/image.h"
#include "object/surface.h"

namespace hydrodip {

// Of what stays without film, and of film where no picture is.
inline constexpr LinearColor kHoldBare{0.55F, 0.55F, 0.55F, 1};
inline constexpr LinearColor kHoldCovered{0.05F, 0.3F, 0.36F, 1};

// In its posed-object frame. Refers to mesh and surface.
struct HoldPicture {
  const TriangleMesh& object;
  const Surface& surface;
  // Linear, opaque: the object as it will look at a point of its surface.
  std::function<LinearColor(const SurfacePoint&, const Vec3& position, const Vec3& normal)> look;
  double depth_mm = 0;
  std::string title;    // "1: lying on its -x side"
  std::string caption;  // figures
};

// One row for each: the object hanging as it comes down, seen from a little below its front (-y),
// and from below, what meets the film. What stays dry is shown paler.
Image render_holds(const std::vector<HoldPicture>& holds, int width_px, const RunContext& context);

// Where in row `row` of a page so wide the picture from below lies.
struct HoldPlace {
  int left_px, top_px, width_px, height_px;
};
HoldPlace hold_from_below(int page_width_px, int row);

}  // namespace hydrodip
