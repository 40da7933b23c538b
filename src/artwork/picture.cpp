#include "artwork/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "image/files.h"
#include "image/resize.h"

namespace hydrodip {
namespace {

// A drawing's pixels: as many as fit 1 GiB, and no side that cairo cannot draw.
constexpr double kMostPixels = 1U << 28U;
constexpr double kLongestSide_px = 32767;
// Finer pixels than this, in those of the print's samples, only take memory and make noise.
constexpr double kFinest = 1.5;

int side_px(double length) { return std::max(1, int(std::lround(length))); }

// Sixteen bits would hold it too, but sums of four are floats anyway.
void add_texel(const std::uint8_t* pixel, float weight, const std::array<float, 256>& decode,
               LinearColor& sum) {
  const float alpha = weight * float(pixel[3]) * (1.0F / 255.0F);
  sum.r += alpha * decode[pixel[0]];
  sum.g += alpha * decode[pixel[1]];
  sum.b += alpha * decode[pixel[2]];
  sum.a += alpha;
}

// A position in a picture's width or height, counted from 0 to 1, as the repetition shows it.
double repeated(double t, Repeat repeat) {
  if (repeat == Repeat::kTile) return t - std::floor(t);
  if (repeat != Repeat::kMirror) return t;
  t -= 2 * std::floor(t / 2);
  return t > 1 ? 2 - t : t;
}

// The two pixels around it.
struct Pair {
  int first, second;
  float weight;  // of the second
};

Pair pair_at(double t, int size, Repeat repeat) {
  const double x = t * size - 0.5;
  const double cell = std::floor(x);
  Pair pair{int(cell), int(cell) + 1, float(x - cell)};
  if (repeat == Repeat::kTile) {
    if (pair.first < 0) pair.first += size;
    if (pair.second >= size) pair.second -= size;
  }
  pair.first = std::clamp(pair.first, 0, size - 1);
  pair.second = std::clamp(pair.second, 0, size - 1);
  return pair;
}

}  // namespace

std::string name_of(const ArtworkLayer& layer) {
  return layer.image.empty() ? "the text '" + layer.text + "'" : layer.image.string();
}

PictureSource::PictureSource(const ArtworkLayer& layer) : name_(name_of(layer)) {
  if (layer.picture) {
    image_ = layer.picture;
    return;
  }
  if (layer.image.empty()) {
    if (layer.text.empty())
      throw InputError("a layer of artwork shows nothing: give it an image or a text");
    drawing_ = Drawing::from_text(layer.text, layer.font, layer.text_color);
    return;
  }
  const std::vector<std::uint8_t> bytes = read_file(layer.image);
  if (looks_like_svg(bytes)) {
    drawing_ = Drawing::from_svg(bytes, name_);
    return;
  }
  image_ = std::make_shared<const Image>(decode_image(bytes, name_));
  const double dpi = recorded_dpi(bytes);
  if (dpi > 0) natural_width_mm_ = image_->width_px * kMmPerInch / dpi;
}

double PictureSource::aspect() const {
  return drawing_ ? drawing_->aspect() : double(image_->width_px) / image_->height_px;
}

std::shared_ptr<const Image> PictureSource::pixels(double width_mm, double height_mm,
                                                   double pixels_per_mm) {
  const double width_px = width_mm * pixels_per_mm, height_px = height_mm * pixels_per_mm;
  if (drawing_) {
    const double shrink = std::min({1.0, kLongestSide_px / std::max(width_px, height_px),
                                    std::sqrt(kMostPixels / std::max(1.0, width_px * height_px))});
    return std::make_shared<const Image>(
        drawing_->pixels(side_px(shrink * width_px), side_px(shrink * height_px)));
  }
  const std::shared_ptr<const Image> image = std::exchange(image_, nullptr);
  if (image->width_px <= kFinest * width_px && image->height_px <= kFinest * height_px)
    return image;
  return std::make_shared<const Image>(resize(*image, std::min(image->width_px, side_px(width_px)),
                                              std::min(image->height_px, side_px(height_px))));
}

PictureFrame::PictureFrame(const Vec2& size_mm, double turn_deg, Repeat repeat)
    : size_mm_(size_mm),
      sine_(std::sin(turn_deg * std::numbers::pi / 180)),
      cosine_(std::cos(turn_deg * std::numbers::pi / 180)),
      repeat_(repeat) {}

Vec2 PictureFrame::to_picture(const Vec2& place_mm) const {
  const double right = cosine_ * place_mm.x() + sine_ * place_mm.y();
  const double up = -sine_ * place_mm.x() + cosine_ * place_mm.y();
  return {0.5 + right / size_mm_.x(), 0.5 - up / size_mm_.y()};
}

bool PictureFrame::misses(const Box2& box_mm) const {
  if (repeat_ != Repeat::kOnce) return false;
  Box2 there;
  for (const double x : {box_mm.min.x(), box_mm.max.x()})
    for (const double y : {box_mm.min.y(), box_mm.max.y()}) there.add(to_picture({x, y}));
  return there.min.x() > 1 || there.max.x() < 0 || there.min.y() > 1 || there.max.y() < 0;
}

LinearColor sample(const Image& image, const PictureFrame& frame, const Vec2& place_mm) {
  const Vec2 t = frame.to_picture(place_mm);
  const Repeat repeat = frame.repeat();
  if (repeat == Repeat::kOnce && !(t.x() >= 0 && t.x() <= 1 && t.y() >= 0 && t.y() <= 1))
    return {0, 0, 0, 0};
  const Pair x = pair_at(repeated(t.x(), repeat), image.width_px, repeat);
  const Pair y = pair_at(repeated(t.y(), repeat), image.height_px, repeat);
  const std::array<float, 256>& decode = srgb8_table();
  LinearColor sum{0, 0, 0, 0};
  add_texel(image.pixel(x.first, y.first), (1 - x.weight) * (1 - y.weight), decode, sum);
  add_texel(image.pixel(x.second, y.first), x.weight * (1 - y.weight), decode, sum);
  add_texel(image.pixel(x.first, y.second), (1 - x.weight) * y.weight, decode, sum);
  add_texel(image.pixel(x.second, y.second), x.weight * y.weight, decode, sum);
  return sum;
}

}  // namespace hydrodip
