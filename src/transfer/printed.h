// What is printed of a point of the object: what is wanted there, or this film's part of it.
#pragma once

#include <optional>
#include <span>

#include "object/paint.h"
#include "transfer/allotment.h"
#include "transfer/sample_landings.h"
#include "transfer/texture_mean.h"
#include "transfer/texture_row.h"

namespace hydrodip {

// Refers to both.
class Printed {
 public:
  Printed(const Paint& paint, const Allotment& allotment);

  // `film_mm`: where on the film it is printed.
  LinearColor at(const SurfacePoint& point, const Vec2& film_mm) const;

  // Of the points that count of some grids, if it is told at once.
  std::optional<LinearColor> mean(std::span<const SurfaceGrid> grids) const;

  // Whether `row` has anything to tell.
  bool is_told_by_row() const { return textured_ != nullptr && textured_->colors.empty(); }
  TextureRow row(const FilmOnPlane& pair) const { return {*textured_, pair, paint_.base()}; }

 private:
  const Paint& paint_;
  const Allotment& allotment_;
  bool depends_on_film_;
  const Object* textured_;  // the paint, if it is nothing else; or null
};

}  // namespace hydrodip
