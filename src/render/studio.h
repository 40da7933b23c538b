// One view of the object in a small photo studio: a plain curved backdrop, a soft lamp from above
// left, a white sky. Light and visibility are worked out once, whatever is then shown in it.
#pragma once

#include <memory>
#include <vector>

#include "base/context.h"
#include "render/appearance.h"
#include "render/normals.h"
#include "render/view.h"

namespace hydrodip {

struct Studio {
  const TriangleMesh& object;
  const Surface& surface;
  const std::vector<CornerNormals>& normals;
  bool smooth_edges = true;  // more samples where neighbouring pixels differ
  // 0: lit as in the studio; 1: no light and shade at all, colours are shown as they are. Maps,
  // whose colours are to be read off, lie between.
  double flatness = 0;
};

// How surfaces look in that light, where other than the studio says.
struct Shading {
  const std::vector<CornerNormals>& normals;
  double flatness = 0;
};

struct ViewPair {
  Image wanted;
  Image predicted;
};

// The view of a camera at a given size. Pictures do not depend on the number of threads. Both calls
// throw Cancelled when the job was cancelled. Refers to what the studio refers to.
class LitView {
 public:
  LitView(const Studio& studio, const Camera& camera, int width_px, int height_px,
          const RunContext& context);
  ~LitView();

  ViewPair show(const Appearance& appearance) const;
  ViewPair show(const Appearance& appearance, const Shading& shading) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydrodip
