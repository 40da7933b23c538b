#include "coat/finish.h"

namespace hydrodip {
namespace {

// At the coat's own pose.
LinearColor laid_over(const Coat& coat, const SurfacePoint& point, const LinearColor& under) {
  const TriangleMesh& mesh = coat.dipped.posed.mesh();
  return predicted_color(*coat.look, coat.raster, *coat.dipped.map, position_at(mesh, point),
                         face_normal(mesh, point.triangle), under);
}

}  // namespace

LinearColor Finish::color_at(const SurfacePoint& point) const {
  LinearColor color = paint_->base();
  for (std::size_t n = 0; n < coats_.size(); ++n) {
    if (n == 0) {
      color = laid_over(coats_[n], point, color);
      continue;
    }
    const LinearColor filter = laid_over(coats_[n], point, {1, 1, 1, 1});
    color = {color.r * filter.r, color.g * filter.g, color.b * filter.b, 1};
  }
  return color;
}

}  // namespace hydrodip
