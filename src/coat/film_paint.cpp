#include "coat/film_paint.h"

#include <utility>

namespace hydrodip {
namespace {

class DippedPaint : public Paint {
 public:
  DippedPaint(std::shared_ptr<const Paint> paint, const DippedObject& dipped)
      : Paint(paint->base()), paint_(std::move(paint)), dipped_(dipped) {}

  LinearColor color_at(const SurfacePoint& point) const override {
    const auto film_mm = dipped_.map->to_film(point);
    return film_mm ? paint_->color_on_film(point, *film_mm) : paint_->color_at(point);
  }
  LinearColor color_on_film(const SurfacePoint& point, const Vec2& film_mm) const override {
    return paint_->color_on_film(point, film_mm);
  }
  bool depends_on_film() const override { return true; }
  bool says_anything() const override { return paint_->says_anything(); }

 private:
  std::shared_ptr<const Paint> paint_;
  DippedObject dipped_;
};

}  // namespace

std::shared_ptr<const Paint> paint_as_dipped(std::shared_ptr<const Paint> paint,
                                             const DippedObject& dipped) {
  if (!paint->depends_on_film()) return paint;
  return std::make_shared<const DippedPaint>(std::move(paint), dipped);
}

}  // namespace hydrodip
