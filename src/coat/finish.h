// What an object looks like in the end: its coats, in the order in which it is dipped, over the
// bare object.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "coat/dipped_object.h"
#include "image/image.h"
#include "object/paint.h"
#include "transfer/raster.h"

namespace hydrodip {

// One dip that is done: where its film lies, and what its ink does to the light.
struct Coat {
  DippedObject dipped;
  SheetRaster raster;
  // Every pixel of the film as it looks on the object: over the bare object's colour for the first
  // coat, over white for those that lie upon others.
  std::shared_ptr<const Image> look;
};

// A value; copies share what is large.
class Finish {
 public:
  Finish(std::shared_ptr<const Paint> paint, std::vector<Coat> coats)
      : paint_(std::move(paint)), coats_(std::move(coats)) {}

  const Paint& paint() const { return *paint_; }
  const std::vector<Coat>& coats() const { return coats_; }

  // Predicted at a point of the object, linear and opaque. Ink is a filter: every coat leaves of
  // the light from below it what it leaves of white. Safe to ask from many threads.
  LinearColor color_at(const SurfacePoint& point) const { return color_at(point, Vec2::Zero()); }
  // The same if every coat but the first has landed off by that much, in its film coordinates.
  LinearColor color_at(const SurfacePoint& point, const Vec2& later_off_mm) const;
  // The same where the film of the first coat has that coordinate, or does not lie.
  LinearColor color_with_film(const SurfacePoint& point,
                              const std::optional<Vec2>& first_film) const;
  // Whether film of any coat lies there.
  bool has_film_at(const SurfacePoint& point) const;

 private:
  LinearColor color_by(const SurfacePoint& point, const std::optional<Vec2>& first_film,
                       const Vec2& later_off_mm) const;

  std::shared_ptr<const Paint> paint_;
  std::vector<Coat> coats_;
};

}  // namespace hydrodip
