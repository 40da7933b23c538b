#include "transfer/printed.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

// Darker than that no ink is, so that a part of it can be told.
constexpr float kDarkest = 0.003F;

// Of a pixel's points, from corner to corner.
constexpr float kNearlyOneShare = 0.15F;

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
      textured_(depends_on_film_ ? nullptr : paint.as_object()) {}

LinearColor Printed::at(const SurfacePoint& point, const Vec2& film_mm) const {
  return part_at(point, film_mm, allotment_.at(point));
}

// Of two opposite corners: a fade is wider than a pixel by far, and at a film's border its points
// are asked one by one.
std::optional<float> Printed::share_of(const SurfaceGrid& grid) const {
  if (const auto share = allotment_.over(grid.first.triangle)) return share;
  const int last = grid.per_axis - 1;
  const float from = allotment_.at(grid.at(0, 0)), to = allotment_.at(grid.at(last, last));
  if (std::abs(from - to) > kNearlyOneShare) return std::nullopt;
  return 0.5F * (from + to);
}

LinearColor Printed::part_at(const SurfacePoint& point, const Vec2& film_mm, float share) const {
  if (share <= 0) return {0, 0, 0, 0};
  const LinearColor color =
      depends_on_film_ ? paint_.color_on_film(point, film_mm) : paint_.color_at(point);
  return share >= 1 ? color : part_of_ink(color, paint_.base(), share);
}

}  // namespace hydrodip
