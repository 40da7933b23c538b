#include "artwork/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "image/picture_file.h"
#include "image/resize.h"

namespace hydrodip {
namespace {

// What a drawing may take: of its tiles that have more than one colour, and as an image.
constexpr std::size_t kMostBytes = std::size_t(1) << 30U;
constexpr double kMostPixels = 1U << 28U, kLongestSide_px = 32767;
// Finer pixels than this, in those of the print's samples, only take memory and make noise.
constexpr double kFinest = 1.5;

int side_px(double length) { return std::max(1, int(std::lround(length))); }

// The share of a size at which it keeps to the limits.
double share_within(const Vec2& size_px, const Drawing::Limits& limits) {
  return std::min({1.0, limits.side_px / size_px.maxCoeff(),
                   std::sqrt(limits.pixels / std::max(1.0, size_px.prod()))});
}

// A position in a picture's width or height, counted from 0 to 1, as the repetition shows it.
double repeated(double t, Repeat repeat) {
  if (repeat == Repeat::kTile) return t - std::floor(t);
  if (repeat != Repeat::kMirror) return t;
  t -= 2 * std::floor(t / 2);
  return t > 1 ? 2 - t : t;
}

// The two pixels around it along the width or height, and the weight of the second.
struct Pair {
  int first, second;
  float weight;

  Pair(double t, int size, Repeat repeat) {
    const double x = t * size - 0.5;
    // std::floor is a call for processors without SSE 4.
    first = int(x);
    if (first > x) --first;
    weight = float(x - first);
    second = first + 1;
    if (repeat == Repeat::kTile) {
      if (first < 0) first += size;
      if (second >= size) second -= size;
    }
    first = std::clamp(first, 0, size - 1);
    second = std::clamp(second, 0, size - 1);
  }
};

template <class Source>
LinearColor sampled(const Source& image, int width_px, int height_px, const PictureFrame& frame,
                    const Vec2& place_mm) {
  const Vec2 t = frame.to_picture(place_mm);
  const Repeat repeat = frame.repeat();
  if (repeat == Repeat::kOnce && !(t.x() >= 0 && t.x() <= 1 && t.y() >= 0 && t.y() <= 1))
    return {0, 0, 0, 0};
  const Pair x(repeated(t.x(), repeat), width_px, repeat);
  const Pair y(repeated(t.y(), repeat), height_px, repeat);
  const std::array<float, 256>& decode = srgb8_table();
  LinearColor sum{0, 0, 0, 0};
  add_pixel(image.pixel(x.first, y.first), (1 - x.weight) * (1 - y.weight), decode, sum);
  add_pixel(image.pixel(x.second, y.first), x.weight * (1 - y.weight), decode, sum);
  add_pixel(image.pixel(x.first, y.second), (1 - x.weight) * y.weight, decode, sum);
  add_pixel(image.pixel(x.second, y.second), x.weight * y.weight, decode, sum);
  return sum;
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
  if (!layer.image.empty() && !layer.text.empty())
    throw InputError(
        fmt::format("{}: a layer of artwork shows an image or a text ('{}'), not both; give the "
                    "text a layer of "
                    "its own ([[artwork]] in a file)",
                    name_, layer.text));
  if (layer.image.empty()) {
    if (layer.text.empty())
      throw InputError("a layer of artwork shows nothing: give it an image or a text");
    fonts_ = fonts_for(layer.text, parse_font(layer.font), name_);
    drawing_ = Drawing::from_text(layer.text, layer.font, layer.text_color);
    return;
  }
  const std::vector<std::uint8_t> bytes = read_file(layer.image);
  if (looks_like_svg(bytes)) {
    drawing_ = Drawing::from_svg(bytes, name_);
    natural_width_mm_ = drawing_->natural_width_mm();
    return;
  }
  image_ = std::make_shared<const Image>(decode_image(bytes, name_, "SVG"));
  const double dpi = scan_dpi(bytes);
  if (dpi > 0) natural_width_mm_ = image_->width_px * kMmPerInch / dpi;
}

double PictureSource::aspect() const {
  return drawing_ ? drawing_->aspect() : double(image_->width_px) / image_->height_px;
}

PictureSource::Shown PictureSource::pixels(const Vec2& size_mm, double pixels_per_mm) {
  const Vec2 size_px = size_mm * pixels_per_mm;
  if (!drawing_) return {Pixels(averaged(size_px))};
  // Where too many tiles have something to show, the next try is half as fine.
  for (double share = share_within(size_px, drawing_->limits());; share /= 2) {
    const Vec2 drawn = share * size_px;
    if (auto tiles = drawing_->tiles(side_px(drawn.x()), side_px(drawn.y()), kMostBytes))
      return {Pixels(std::move(*tiles)), share};
  }
}

std::shared_ptr<const Image> PictureSource::image(const Vec2& size_mm, double pixels_per_mm) {
  const Vec2 size_px = size_mm * pixels_per_mm;
  if (!drawing_) return averaged(size_px);
  const Vec2 drawn = size_px * std::min(share_within(size_px, drawing_->limits()),
                                        share_within(size_px, {kMostPixels, kLongestSide_px}));
  return std::make_shared<const Image>(drawing_->pixels(side_px(drawn.x()), side_px(drawn.y())));
}

std::shared_ptr<const Image> PictureSource::averaged(const Vec2& size_px) {
  std::shared_ptr<const Image> image = std::exchange(image_, nullptr);
  if (image->width_px <= kFinest * size_px.x() && image->height_px <= kFinest * size_px.y())
    return image;
  return std::make_shared<const Image>(
      resize(*image, int(std::min(double(image->width_px), std::max(1.0, std::round(size_px.x())))),
             int(std::min(double(image->height_px), std::max(1.0, std::round(size_px.y()))))));
}

bool Pixels::shows_anything() const {
  if (!image_) return tiles_.shows_anything();
  CheckEvery check(1 << 20);
  for (std::size_t i = 3; i < image_->rgba.size(); i += 4) {
    check();
    if (image_->rgba[i] > 0) return true;
  }
  return false;
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
  return sampled(image, image.width_px, image.height_px, frame, place_mm);
}

LinearColor sample(const Pixels& pixels, const PictureFrame& frame, const Vec2& place_mm) {
  return sampled(pixels, pixels.width_px(), pixels.height_px(), frame, place_mm);
}

}  // namespace hydrodip
