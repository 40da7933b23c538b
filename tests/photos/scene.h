// Photos by code: flat sheets before a camera with a lens that bends, perspective, blur, noise,
// glare and uneven light. Every figure that is found with them is of synthetic photos.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "camera/lens.h"
#include "tags/mark.h"
#include "tags/seen_marks.h"

namespace hydrodip::fixtures {

// A picture of a sheet, seen from its printed side.
struct SheetPicture {
  GrayImage gray;
  double px_per_mm = 20;
  Vec2 upper_left_mm = Vec2::Zero();  // of the picture, in the sheet's frame (y up)
  // Per square millimetre from the upper left: not all white within 3 mm. Empty: not known.
  std::vector<std::uint8_t> inked;
  int inked_width = 0;
};
void find_ink(SheetPicture& picture);

// Boxes on the free film of an A4 sheet, from its middle; of those of another job none is the same,
// though both lie around the middle.
std::vector<Box2> boxes_on_a4(std::uint32_t job);

// Black boxes on white, each pixel as much as it is covered.
SheetPicture draw_boxes(const std::vector<Box2>& boxes, const Box2& sheet, double px_per_mm = 20);
// The same of marks.
SheetPicture draw_marks(const std::vector<MarkPlace>& marks, const Box2& sheet,
                        double px_per_mm = 20);

struct PlacedSheet {
  const SheetPicture* picture = nullptr;
  Pose pose;                    // sheet to tank
  Vec2 stretch = Vec2::Ones();  // of the sheet before that
  bool mirrored = false;        // seen from its back
};

struct Glare {
  Vec2 at_px;
  double radius_px = 100, strength = 200;
};

struct Scene {
  int width_px = 4000, height_px = 3000;
  Lens lens;
  Pose camera;  // tank to camera
  std::vector<PlacedSheet> sheets;
  double background = 70, light_black = 25, light_white = 200;
  Vec2 shade = Vec2::Zero();  // by how much light grows over the picture's width and height
  std::vector<Glare> glare;
  double blur_px = 0.8;  // standard deviation
  double noise = 3;      // the same, of 255
  std::uint32_t seed = 1;
};
GrayImage photograph(const Scene& scene);

// A phone: 12 megapixels, a wide lens that bends like a barrel.
Lens phone_lens();
// From `eye` towards `target`, both in the tank frame, turned about that direction.
Pose look_at(const Vec3& eye, const Vec3& target, double roll_deg);

// Four strips around a tank of 370 x 270 mm, not quite level, and the way to see them.
struct SyntheticTank {
  std::vector<Pose> strip;  // strip frame to tank
  std::vector<SheetPicture> picture;
  std::vector<PlacedSheet> sheets() const;
  // What a camera would see without noise, but for `noise_px` of each corner.
  std::vector<SeenMark> seen(const Lens& lens, const Pose& camera, double noise_px,
                             std::mt19937& random) const;
};
SyntheticTank synthetic_tank(bool draw);
// A view from some 0.5 m in which the whole tank is to be seen.
Pose random_view(std::mt19937& random, double tilt_deg = 12);

}  // namespace hydrodip::fixtures
