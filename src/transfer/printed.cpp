#include "transfer/printed.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

// Darker than that no ink is, so that a part of it can be told.
constexpr float kDarkest = 0.003F;

// A part of the ink that makes `base` look like `wanted`: ink is a filter, so that the parts of
// several films multiply to what the whole ink leaves of the light.
LinearColor part_of_ink(const LinearColor& wanted, const LinearColor& base, float share) {
  const auto part = [&](float w, float b) {
    if (!(b > 0)) return w;
    return b * std::pow(std::clamp(w / b, kDarkest, 1.0F), share);
  };
  return {part(wanted.r, base.r), part(wanted.g, base.g), part(wanted.b, base.b), wanted.a};
}

}  // namespace

Printed::Printed(const Paint& paint, const Allotment& allotment)
    : paint_(paint),
      allotment_(allotment),
      depends_on_film_(paint.depends_on_film()),
      textured_(allotment.is_full() && !depends_on_film_ ? paint.as_object() : nullptr) {}

LinearColor Printed::at(const SurfacePoint& point, const Vec2& film_mm) const {
  const LinearColor color =
      depends_on_film_ ? paint_.color_on_film(point, film_mm) : paint_.color_at(point);
  const float share = allotment_.at(point);
  if (share >= 1) return color;
  if (share <= 0) return {0, 0, 0, 0};
  return part_of_ink(color, paint_.base(), share);
}

}  // namespace hydrodip
