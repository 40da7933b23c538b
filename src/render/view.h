// Where to look from, and the camera that stands there.
#pragma once

#include <array>
#include <vector>

#include "film/film.h"
#include "object/object.h"
#include "object/posed_object.h"
#include "object/surface.h"

namespace hydrodip {

// Which way is up for a person who looks at the object, and which side is its front. Unit, in the
// frame of the mesh that is shown, at right angles.
struct Standing {
  Vec3 up = Vec3::UnitY();
  Vec3 front = -Vec3::UnitZ();
};

// Of a posed object whose model stands with `up` up: its front is then -y, or with +y or -y up -z.
Standing standing_of(const PosedObject& posed, ModelSide up);

// Two unit directions from the object towards the eye: the first sees most of the area where film
// lies on the object, the second most of what the first does not see. Without any such film
// what faces down counts, and without that the whole surface. Looking from below (-z, the side that
// meets the film) is the front, unless `standing` says otherwise.
std::array<Vec3, 2> telling_directions(const TriangleMesh& object, const Surface& surface,
                                       const DippedFilm& film, const Standing& standing = {});

// A small piece of surface that a picture should show.
struct SurfacePatch {
  Vec3 position;
  Vec3 normal;  // unit, outward
  double area;
};
// The same for these pieces of the object's surface, of which there is one at least.
std::array<Vec3, 2> telling_directions(const TriangleMesh& object, const Surface& surface,
                                       const std::vector<SurfacePatch>& patches,
                                       const Standing& standing);

// A perspective camera. Screen coordinates: x right and y up, both in [-1, 1].
struct Camera {
  Vec3 eye = Vec3::Zero();
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitY();
  Vec3 back = Vec3::UnitZ();               // from the object towards the eye
  double half_width = 1, half_height = 1;  // of the screen, at distance 1
  double shift_y = 0;                      // screen centre above the axis, at distance 1

  // Direction (not unit length) of the ray through a screen point.
  Vec3 ray(double x, double y) const;
};

// The object's extent across the picture over its extent up, as seen along `direction`.
double projected_aspect(const TriangleMesh& object, const Vec3& direction,
                        const Standing& standing = {});

// The camera that sees the whole object from `direction`, filling `fill` of a picture of the given
// aspect (width over height) in the tighter extent. What stands up is up wherever it can be.
Camera frame_object(const TriangleMesh& object, const Vec3& direction, double aspect, double fill,
                    const Standing& standing = {});

}  // namespace hydrodip
