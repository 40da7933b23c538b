#include "coat/finish.h"

#include <algorithm>
#include <optional>

namespace hydrodip {
namespace {

// At the coat's own pose; nothing where its film does not lie.
std::optional<Vec2> film_point(const Coat& coat, const SurfacePoint& point) {
  return coat.dipped.map->to_film(point);
}

LinearColor laid_over(const Coat& coat, const Vec2& u, const LinearColor& under) {
  const LinearColor ink = sample_film_image(*coat.look, coat.raster, u);
  const float bare = 1 - ink.a;
  return {ink.a * ink.r + bare * under.r, ink.a * ink.g + bare * under.g,
          ink.a * ink.b + bare * under.b, 1};
}

}  // namespace

LinearColor Finish::color_at(const SurfacePoint& point, const Vec2& later_off_mm) const {
  return color_by(point, coats_.empty() ? std::nullopt : film_point(coats_[0], point),
                  later_off_mm);
}

LinearColor Finish::color_with_film(const SurfacePoint& point,
                                    const std::optional<Vec2>& first_film) const {
  return color_by(point, first_film, Vec2::Zero());
}

LinearColor Finish::color_by(const SurfacePoint& point, const std::optional<Vec2>& first_film,
                             const Vec2& later_off_mm) const {
  LinearColor color = paint_->base();
  for (std::size_t n = 0; n < coats_.size(); ++n) {
    const auto u = n == 0 ? first_film : film_point(coats_[n], point);
    if (!u) continue;
    if (n == 0) {
      color = laid_over(coats_[n], *u, color);
      continue;
    }
    const LinearColor filter = laid_over(coats_[n], *u + later_off_mm, {1, 1, 1, 1});
    color = {color.r * filter.r, color.g * filter.g, color.b * filter.b, 1};
  }
  return color;
}

bool Finish::has_film_at(const SurfacePoint& point) const {
  return std::any_of(coats_.begin(), coats_.end(),
                     [&](const Coat& coat) { return film_point(coat, point).has_value(); });
}

}  // namespace hydrodip
