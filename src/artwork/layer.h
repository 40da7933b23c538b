// Artwork: a picture, drawing or text that is put on the object, whatever colours the model has.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

// Planar, cylinder, sphere and box push the picture through space onto what they meet first; wrap
// lays it on the surface, from its centre outwards; uv follows the model's texture coordinates;
// film leaves it on the film, to be stretched with it.
enum class Projection { kPlanar, kCylinder, kSphere, kBox, kUv, kWrap, kFilm };
enum class Repeat { kOnce, kTile, kMirror };
enum class Blend { kNormal, kMultiply };

// Lengths and directions in the model's frame, after it was scaled and before it is turned
// (PoseOptions). What is not given is chosen: see docs/artwork.md.
struct ArtworkLayer {
  std::filesystem::path image;           // PNG, JPEG, WebP, TIFF, ..., or SVG; or, without one:
  std::shared_ptr<const Image> picture;  // in the file's place, if it is at hand already
  std::string text;
  std::string font = "sans bold";  // of text, by its name on this machine
  LinearColor text_color{0, 0, 0, 1};

  Projection projection = Projection::kPlanar;
  std::optional<Vec3> at_mm;  // the picture's centre; film: x and y on the film
  // The way it is projected; of cylinder and sphere the axis. Need not have length 1.
  std::optional<Vec3> toward;
  std::optional<Vec3> up;  // towards the picture's upper edge
  double width_mm = 0;     // on the surface; 0: by the height, or as large as fits
  double height_mm = 0;    // 0: by the width
  double turn_deg = 0;     // counter-clockwise as one sees the picture
  Repeat repeat = Repeat::kOnce;
  bool through = false;  // also on what lies behind the first surface
  double fade_deg = 90;  // fades out from there to 90 degrees between surface and projection
  double opacity = 1;    // 0 to 1
  Blend blend = Blend::kNormal;
};

// "logo.png", or the text: for messages.
std::string name_of(const ArtworkLayer& layer);

}  // namespace hydrodip
