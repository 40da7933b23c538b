// What came of a layer of artwork.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "artwork/fonts.h"
#include "artwork/layer.h"
#include "base/math.h"
#include "object/object.h"

namespace hydrodip {

struct LaidLayer {
  std::string name;
  ArtworkLayer layer;             // so that it lies there however the object is held
  bool has_chosen_place = false;  // it was told none
  Vec2 size_mm{0, 0};
  // Wrapped: lengths on the surface over the picture's.
  double stretch_least = 1, stretch_most = 1;
  std::vector<FontUse> fonts;  // of a text
  // Whether anything of it shows at a point of the object, if nothing lies above it. Safe to ask
  // from many threads; empty: it is laid on the film.
  std::function<bool(const SurfacePoint&)> shows;
};

}  // namespace hydrodip
