// Pictures pushed through space: by parallel rays, towards an axis, towards a centre, from six
// sides.
#pragma once

#include <memory>
#include <string>

#include "artwork/placement.h"

namespace hydrodip {

// In the posed-object frame. Immutable.
class Projector {
 public:
  virtual ~Projector() = default;
  // Where a point lies in the picture's plane. The normal is its triangle's.
  virtual Vec2 flat(const Vec3& point, const Vec3& normal) const = 0;
  // Unit vector from a point to where the picture comes from.
  virtual Vec3 back(const Vec3& point, const Vec3& normal) const = 0;
  // Whether a triangle lies in the plane as between its corners: else nothing can be said of those
  // that are wider than `curved_mm()`.
  virtual double curved_mm() const { return 1e300; }
  // Whether the normal matters.
  virtual bool has_sides() const { return false; }
};

struct Aimed {
  std::unique_ptr<const Projector> projector;
  Vec2 size_mm;
  ArtworkLayer layer;  // as of Placed
};

// A projector for a layer's projection, with what the layer leaves open chosen. Throws InputError.
Aimed aim(const PlacementTask& task);

// The surface's nearest point to a layer's own position, which must not be far away. Throws
// InputError saying where the surface is.
SurfaceHit nearest_to(const PlacementTask& task, const Vec3& at);

// Where somebody stands who looks at the surface there: its unit normal, or the other way if the
// surface has no inside and can be seen from more directions there.
Vec3 seen_from(const PlacementTask& task, const SurfaceHit& hit);

// From the model's frame, after scaling, to the posed-object frame.
struct ModelFrame {
  Mat3 turn;
  Vec3 offset;
  explicit ModelFrame(const PosedObject& posed);
  Vec3 point(const Vec3& p) const { return turn * p + offset; }
  Vec3 back(const Vec3& posed) const { return turn.transpose() * (posed - offset); }
  Vec3 direction_back(const Vec3& posed) const { return turn.transpose() * posed; }
};

// As it is written down: without the last bits that turning a place or direction there and back
// leaves (mm, or of length 1).
Vec3 rounded(const Vec3& v);

// "1.0,2.0,3.0", as options take it.
std::string as_given(const Vec3& p);

// The picture's directions for somebody who looks along `toward`: right and up, of length 1, square
// to it. Throws InputError if the layer's own `up` is parallel to it.
struct Upright {
  Vec3 right, up;
};
Upright upright(const PlacementTask& task, const Vec3& toward);

// Width and height: the layer's, or the largest that stay within the room on either side of the
// centre, turned as they are.
Vec2 fitting_size(const PlacementTask& task, const Vec2& room_mm);

}  // namespace hydrodip
