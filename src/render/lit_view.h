// One view of the object in a small photo studio, before a plain curved backdrop. Light and
// visibility are worked out once, whatever is then shown in it.
#pragma once

#include <memory>
#include <vector>

#include "base/context.h"
#include "image/image.h"
#include "render/appearance.h"
#include "render/lit_pixels.h"
#include "render/normals.h"
#include "render/view.h"

namespace hydrodip {

// How surfaces look in that light.
struct Shading {
  const std::vector<CornerNormals>& normals;
  // 0: lit as in the studio; 1: no light and shade at all, colours are shown as they are. Maps,
  // whose colours are to be read off, lie between.
  double flatness = 0;
  bool smooth_edges = true;  // more samples where neighbouring pixels differ
};

struct ViewPair {
  Image wanted;
  Image predicted;
};

// The view of a camera at a given size. Pictures do not depend on the number of threads. All calls
// throw Cancelled when the job was cancelled. Refers to what the object refers to.
class LitView {
 public:
  LitView(const LitObject& object, const Camera& camera, int width_px, int height_px,
          const RunContext& context);

  // By the object's own normals.
  ViewPair show(const Appearance& appearance) const;
  ViewPair show(const Appearance& appearance, const Shading& shading) const;

 private:
  LitPixels pixels_;
};

}  // namespace hydrodip
