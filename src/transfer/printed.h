// What is printed of a point of the object: what is wanted there, or this film's part of it.
#pragma once

#include <optional>

#include "object/paint.h"
#include "transfer/allotment.h"
#include "transfer/color_sum.h"
#include "transfer/texture_mean.h"

namespace hydrodip {

// Refers to both.
class Printed {
 public:
  Printed(const Paint& paint, const Allotment& allotment);

  // `film_mm`: where on the film it is printed.
  LinearColor at(const SurfacePoint& point, const Vec2& film_mm) const;

  // The mean over those of a grid's points that count; `film_mm(column, row)`: where they come
  // from.
  template <class OnFilm>
  LinearColor mean(const SurfaceGrid& grid, const OnFilm& film_mm) const {
    const std::optional<float> share = share_of(grid);
    if (share == 0.0F) return {0, 0, 0, 0};
    if (share == 1.0F && textured_ != nullptr)
      if (const auto color = mean_texture_color(*textured_, grid, paint_.base())) return *color;
    const float weight = 1.0F / static_cast<float>(grid.count());
    ColorSum sum;
    for (int row = 0; row < grid.per_axis; ++row)
      for (int column = 0; column < grid.per_axis; ++column) {
        if (!grid.counts(column, row)) continue;
        const SurfacePoint point = grid.at(column, row);
        const Vec2 from = film_mm(column, row);
        sum.add(share ? part_at(point, from, *share) : at(point, from), weight);
      }
    return sum.color();
  }

 private:
  // This film's part of all of a grid's points, if they have nearly one.
  std::optional<float> share_of(const SurfaceGrid& grid) const;
  LinearColor part_at(const SurfacePoint& point, const Vec2& film_mm, float share) const;

  const Paint& paint_;
  const Allotment& allotment_;
  bool depends_on_film_;
  const Object* textured_;  // the paint, if it is nothing else; or null
};

}  // namespace hydrodip
