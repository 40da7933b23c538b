// Where on the surface a layer's picture lies.
#pragma once

#include <memory>

#include "artwork/layer.h"
#include "artwork/picture.h"
#include "object/posed_object.h"

namespace hydrodip {

// A point of the surface, in the picture's plane.
struct Spot {
  Vec2 place_mm;  // to the right and up from the picture's centre
  float share;    // of the picture that is left there, in (0, 1]
};

// Immutable, safe to ask from many threads.
class Placement {
 public:
  virtual ~Placement() = default;
  // False where nothing of the picture comes to lie, even if nothing is in its way.
  virtual bool find(const SurfacePoint& point, Spot& spot) const = 0;
  // Whether nothing is in its way. Dearer: to be asked where the picture shows something.
  virtual bool is_lit(const SurfacePoint&) const { return true; }
};

// A picture that has found its place.
struct Placed {
  std::unique_ptr<const Placement> placement;
  Vec2 size_mm;        // of the picture, on the surface
  ArtworkLayer layer;  // with what goes by the pose given: it lies there in any other one, too
};

// What a placement is made from. `closed`: the surface has an inside.
struct PlacementTask {
  const ArtworkLayer& layer;
  double aspect;  // of the picture, width over height
  const PosedObject& posed;
  bool closed;
};

// Throws InputError for directions that say nothing, and for a place where the model is not.
Placed place_pushed(const PlacementTask& task);  // planar, cylinder, sphere, box
Placed place_by_uv(const PlacementTask& task);
// What laying a picture on curved surface does to it.
struct WrapReport {
  double stretch_most = 1, stretch_least = 1;  // of the picture's lengths, where it shows
  double folded_mm2 = 0;                       // of the surface, where the picture lies over itself
};
Placed place_wrapped(const PlacementTask& task, WrapReport& report);

}  // namespace hydrodip
