// What the sample makers share. Private to the samples.
//
// They work in the printed side's frame: x to the right, y up, height towards a person who looks at
// the printed side. The posed frame looks at that person from above (the printed side faces -z), so
// x changes its sign with z and nothing is mirrored.
#pragma once

#include "base/math.h"
#include "image/image.h"
#include "object/object.h"

namespace hydrodip {

inline Vec3 posed(double x, double y, double height) { return {-x, y, -height}; }

// Lifts the object so that its lowest point is at z = 0.
void rest_on_zero(Object& object);

// Gives every corner the texture coordinate of its place in the printed side's frame, looked at
// straight on; the texture covers width_mm x height_mm centred at the origin.
void set_planar_uvs(Object& object, double width_mm, double height_mm);

// The single material that wears this texture.
void set_texture(Object& object, const std::string& name, Image image);

// A checkerboard of 5 mm squares centred at the origin, each quadrant in its own colour and an F in
// the first one, so that a turned or mirrored print shows.
Image checkerboard(double size_mm);

Object make_sphere();
Object make_pyramid();
Object make_ellipsoid();
Object make_box();
Object make_mask();

// The mask's painted side, kMaskTextureWidthMm x kMaskTextureHeightMm.
Image paint_mask();
constexpr double kMaskTextureWidthMm = 110;
constexpr double kMaskTextureHeightMm = 140;

// The mask's outline: a point of the plane has mask_radius < 1 inside it and 1 on it; mask_point is
// the inverse, from (radius, angle).
double mask_radius(const Vec2& p);
Vec2 mask_point(double radius, double angle_rad);

}  // namespace hydrodip
