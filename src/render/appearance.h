// What both previews show: wanted and predicted colour of any point of the object.
#pragma once

#include <functional>

#include "object/object.h"
#include "object/surface.h"

namespace hydrodip {

struct Appearance {
  // Linear colour at a point of the object's surface; opaque. `normal` is the unit face normal.
  std::function<LinearColor(const SurfacePoint&, const Vec3& position, const Vec3& normal)> wanted;
  std::function<LinearColor(const SurfacePoint&, const Vec3& position, const Vec3& normal)>
      predicted;
};

}  // namespace hydrodip
