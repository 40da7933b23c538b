// What colour is wanted where: the one question that film images, predictions and pictures ask.
#pragma once

#include <memory>

#include "object/object.h"

namespace hydrodip {

// Immutable, safe to ask from many threads.
class Paint {
 public:
  virtual ~Paint() = default;

  // The wanted colour at a point of the surface, in linear light: over the bare object's, opaque.
  // Textures at full resolution: callers antialias by supersampling.
  virtual LinearColor color_at(const SurfacePoint& point) const = 0;

  // The same where film lies whose coordinate there is `film_mm`: colours may depend on it.
  virtual LinearColor color_on_film(const SurfacePoint& point, const Vec2& film_mm) const {
    static_cast<void>(film_mm);
    return color_at(point);
  }
  virtual bool depends_on_film() const { return false; }

  // Whether anything but the bare object's colour is wanted anywhere.
  virtual bool says_anything() const = 0;

  // The colours as textures and corner colours of an object with the same triangles, if they are
  // given so; else null, and who needs them so bakes them (object/bake.h).
  virtual const Object* as_object() const { return nullptr; }

  // Of the bare object, linear, opaque.
  const LinearColor& base() const { return base_; }

 protected:
  explicit Paint(const LinearColor& base) : base_(base) {}

 private:
  LinearColor base_;
};

// The colours that a model came with: textures, materials, vertex colours. One that says nothing of
// its colour is wanted as it is, bare.
std::shared_ptr<const Paint> model_paint(std::shared_ptr<const Object> object,
                                         const LinearColor& base = {1, 1, 1, 1});

}  // namespace hydrodip
