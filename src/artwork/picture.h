// A layer's picture, read and ready to be asked for colours.
#pragma once

#include <memory>
#include <optional>

#include "artwork/drawing.h"
#include "artwork/layer.h"

namespace hydrodip {

// As its file has it.
class PictureSource {
 public:
  // Reads the layer's file, or sets its text. Throws InputError: missing, broken, no picture.
  explicit PictureSource(const ArtworkLayer& layer);

  double aspect() const;  // width over height
  // Of a picture of pixels: as its file says, else 0.
  double natural_width_mm() const { return natural_width_mm_; }

  // The pixels for a picture that is so wide on the surface: a drawing becomes as fine as
  // `pixels_per_mm`, and of finer pixels means are taken. Once.
  std::shared_ptr<const Image> pixels(double width_mm, double height_mm, double pixels_per_mm);

 private:
  std::string name_;
  std::optional<Drawing> drawing_;
  std::shared_ptr<const Image> image_;
  double natural_width_mm_ = 0;
};

// How a picture lies in its plane: millimetres to the right and up from its centre.
class PictureFrame {
 public:
  // size: width and height in mm, both positive.
  PictureFrame(const Vec2& size_mm, double turn_deg, Repeat repeat);

  // From 0 to 1 to the right and down, beyond that where the picture is repeated or has ended.
  Vec2 to_picture(const Vec2& place_mm) const;
  // Whether a picture that is there once ends before this box.
  bool misses(const Box2& box_mm) const;

  const Vec2& size_mm() const { return size_mm_; }
  Repeat repeat() const { return repeat_; }

 private:
  Vec2 size_mm_;
  double sine_, cosine_;
  Repeat repeat_;
};

// Premultiplied colour in linear light, bilinear; nothing beyond the edge of a picture that is
// there once.
LinearColor sample(const Image& image, const PictureFrame& frame, const Vec2& place_mm);

}  // namespace hydrodip
