#include "session/appearance_of.h"

namespace hydrodip {

Appearance appearance_of(const Finish& finish) {
  Appearance result;
  result.wanted = [&paint = finish.paint(), says = finish.paint().says_anything()](
                      const SurfacePoint& point, const Vec3&, const Vec3&) {
    return says ? paint.color_at(point) : paint.base();
  };
  result.predicted = [&finish](const SurfacePoint& point, const Vec3&, const Vec3&) {
    return finish.color_at(point);
  };
  return result;
}

}  // namespace hydrodip
