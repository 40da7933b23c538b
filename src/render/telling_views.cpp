#include "render/telling_views.h"

#include <algorithm>
#include <cmath>

#include "base/run_scope.h"
#include "render/canvas.h"

namespace hydrodip {
namespace {

constexpr double kFill = 0.80;  // of a cell, by the object

}  // namespace

ViewLayout::ViewLayout(const TriangleMesh& object, const std::array<Vec3, 2>& directions,
                       int width_px, const Standing& standing) {
  width = std::clamp(width_px, 64, kWidestPicture_px);
  unit = width / 1600.0;
  margin = px(28);
  gap = px(12);
  cell_width = (width - 2 * margin - gap) / 2;
  for (std::size_t i = 0; i < 2; ++i) {
    const double share =
        std::clamp(1 / projected_aspect(object, directions[i], standing), 0.55, 0.95);
    cell_height[i] = std::max(8, int(std::lround(share * cell_width)));
  }
}

int ViewLayout::px(double length) const { return int(std::lround(length * unit)); }

TellingViews::TellingViews(const TriangleMesh& object, const Surface& surface,
                           const std::array<Vec3, 2>& directions, int width_px,
                           const Standing& standing, const RunContext& context)
    : standing_(standing),
      directions_(directions),
      layout_(object, directions_, width_px, standing),
      normals_(corner_normals(object.positions, object.triangles)) {
  const RunScope scope(context);
  const LitObject lit{object, surface, normals_};
  for (std::size_t i = 0; i < 2; ++i) {
    const int height = layout_.cell_height[i];
    cameras_[i] =
        frame_object(object, directions_[i], double(layout_.cell_width) / height, kFill, standing);
    views_[i] =
        std::make_unique<const LitView>(lit, cameras_[i], layout_.cell_width, height, context);
  }
}

}  // namespace hydrodip
