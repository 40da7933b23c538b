// What is printed of a point of the object: what is wanted there, or this film's part of it.
#pragma once

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
    if (textured_ != nullptr)
      if (const auto color = mean_texture_color(*textured_, grid, paint_.base())) return *color;
    const float weight = 1.0F / static_cast<float>(grid.count());
    ColorSum sum;
    for (int row = 0; row < grid.per_axis; ++row)
      for (int column = 0; column < grid.per_axis; ++column)
        if (grid.counts(column, row))
          sum.add(at(grid.at(column, row), film_mm(column, row)), weight);
    return sum.color();
  }

 private:
  const Paint& paint_;
  const Allotment& allotment_;
  bool depends_on_film_;
  const Object* textured_;  // the paint, if it is nothing else; or null
};

}  // namespace hydrodip
