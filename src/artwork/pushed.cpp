// Pictures that are pushed onto the object through space.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "artwork/placement.h"
#include "artwork/projector.h"
#include "artwork/shadow.h"

namespace hydrodip {
namespace {

class Pushed : public Placement {
 public:
  Pushed(const PlacementTask& task, std::unique_ptr<const Projector> projector, const Vec2& size_mm)
      : mesh_(task.posed.mesh()),
        sides_(projector->has_sides()),
        through_(task.layer.through),
        fade_(task.layer.fade_deg * std::numbers::pi / 180),
        projector_(std::move(projector)),
        shadow_(task.posed, *projector_,
                PictureFrame(size_mm, task.layer.turn_deg, task.layer.repeat), task.closed,
                task.layer.through) {
    if (task.layer.fade_deg < 90) slope_.emplace(mesh_);
  }

  bool find(const SurfacePoint& point, Spot& spot) const override {
    if (shadow_.is_dark(point.triangle)) return false;
    const Vec3 position = position_at(mesh_, point);
    const Vec3 normal = sides_ ? face_normal(mesh_, point.triangle) : Vec3(Vec3::UnitZ());
    spot.place_mm = projector_->flat(position, normal);
    spot.share = slope_ ? faded(point, position, normal) : 1;
    return spot.share > 0;
  }
  // Asked only where the picture shows something.
  bool is_lit(const SurfacePoint& point) const override {
    return shadow_.is_lit(point, position_at(mesh_, point));
  }

 private:
  float faded(const SurfacePoint& point, const Vec3& position, const Vec3& normal) const {
    double cosine = slope_->normal(point).dot(projector_->back(position, normal));
    if (through_) cosine = std::abs(cosine);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)), square = 0.5 * std::numbers::pi;
    return float(std::clamp((square - angle) / (square - fade_), 0.0, 1.0));
  }

  const TriangleMesh& mesh_;
  bool sides_, through_;
  double fade_;
  std::unique_ptr<const Projector> projector_;
  Shadow shadow_;
  std::optional<Slope> slope_;
};

}  // namespace

Placed place_pushed(const PlacementTask& task) {
  Aimed aimed = aim(task);
  return {std::make_unique<Pushed>(task, std::move(aimed.projector), aimed.size_mm), aimed.size_mm,
          std::move(aimed.layer)};
}

}  // namespace hydrodip
