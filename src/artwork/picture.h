// A layer's picture, read and ready to be asked for colours.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "artwork/drawing.h"
#include "artwork/fonts.h"
#include "artwork/layer.h"
#include "artwork/tiled_image.h"

namespace hydrodip {

// Whole, or in tiles: what a layer shows. Immutable, safe to ask from many threads.
class Pixels {
 public:
  explicit Pixels(std::shared_ptr<const Image> image)
      : image_(std::move(image)), width_px_(image_->width_px), height_px_(image_->height_px) {}
  explicit Pixels(TiledImage tiles)
      : tiles_(std::move(tiles)), width_px_(tiles_.width_px()), height_px_(tiles_.height_px()) {}

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  const std::uint8_t* pixel(int x, int y) const {
    return image_ ? image_->pixel(x, y) : tiles_.pixel(x, y);
  }
  bool shows_anything() const;

 private:
  std::shared_ptr<const Image> image_;
  TiledImage tiles_;  // where there is no image
  int width_px_, height_px_;
};

// As its file has it.
class PictureSource {
 public:
  // Reads the layer's file, or sets its text. Throws InputError: missing, broken, no picture, a
  // letter that no font has.
  explicit PictureSource(const ArtworkLayer& layer);

  double aspect() const;  // width over height
  // As its file says (PNG, JPEG, TIFF, SVG in absolute units), else 0.
  double natural_width_mm() const { return natural_width_mm_; }
  // What a text is set in.
  const std::vector<FontUse>& fonts() const { return fonts_; }
  // Of an SVG drawing; else of nothing.
  SvgContents contents() const { return drawing_ ? drawing_->contents() : SvgContents(); }

  // What is shown of a picture that is so large on the surface: a drawing becomes as fine as
  // `pixels_per_mm`, or as fine as it can be; of finer pixels means are taken. Once.
  struct Shown {
    Pixels pixels;
    double share = 1;  // of the fineness that was asked for: less than 1 for immense drawings
  };
  Shown pixels(const Vec2& size_mm, double pixels_per_mm);
  // The same as an image, a drawing coarser if that would take a gigabyte.
  std::shared_ptr<const Image> image(const Vec2& size_mm, double pixels_per_mm);

 private:
  std::shared_ptr<const Image> averaged(const Vec2& size_px);

  std::string name_;
  std::optional<Drawing> drawing_;
  std::shared_ptr<const Image> image_;
  double natural_width_mm_ = 0;
  std::vector<FontUse> fonts_;
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
LinearColor sample(const Pixels& pixels, const PictureFrame& frame, const Vec2& place_mm);

}  // namespace hydrodip
