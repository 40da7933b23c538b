#include "artwork/drawing.h"

#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "artwork/fonts.h"
#include "artwork/picture_marks.h"
#include "base/error.h"
#include "base/run_scope.h"
#include "image/files.h"

namespace hydrodip {
namespace {

struct Unref {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(GInputStream* stream) const { g_object_unref(stream); }
  void operator()(GError* error) const { g_error_free(error); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
template <class Type>
using Owned = std::unique_ptr<Type, Unref>;

// librsvg asks FreeType for letters of font size times scale squared, which has a limit: the larger
// the font, the larger it can be drawn, and the shorter a line can be (900 letters).
constexpr double kFontSize = 4000, kLargestLetter_px = 15000;
constexpr double kLineSpacing = 1.2;
// Around the letters, so that no outline is cut.
constexpr double kTextPad = 0.01 * kFontSize;
// cairo's, one of which librsvg needs around what it mixes as a whole, and as many as fit half a
// GiB, for each of the surfaces on which it does.
constexpr double kLongestSide_px = 32767 - 1, kMostPixelsAtOnce = 1U << 27U;
// What cannot be drawn at this size is broken.
constexpr int kSafeSide_px = 4096;
// Of drawings that need not be drawn at once: more than A3 at 3600 pixels an inch has.
constexpr double kMostPixels = 4e9;

std::string message_of(GError* error) {
  const Owned<GError> owned(error);
  return owned && owned->message ? owned->message : "no reason given";
}

// Null with a reason.
Owned<RsvgHandle> parse(std::string_view text, std::string& why, bool is_limited) {
  GError* error = nullptr;
  const Owned<GInputStream> stream(
      g_memory_input_stream_new_from_data(text.data(), gssize(text.size()), nullptr));
  Owned<RsvgHandle> handle(rsvg_handle_new_from_stream_sync(
      stream.get(), nullptr, is_limited ? RSVG_HANDLE_FLAGS_NONE : RSVG_HANDLE_FLAG_UNLIMITED,
      nullptr, &error));
  if (!handle) why = message_of(error);
  return handle;
}

// Width and height in whatever unit; zero if the drawing has none and nothing to see either.
Vec2 natural_size(RsvgHandle* handle) {
  double width = 0, height = 0;
  if (rsvg_handle_get_intrinsic_size_in_pixels(handle, &width, &height) && width > 0 && height > 0)
    return {width, height};
  gboolean has_width = FALSE, has_height = FALSE, has_box = FALSE;
  RsvgLength ignored_width, ignored_height;
  RsvgRectangle box{};
  rsvg_handle_get_intrinsic_dimensions(handle, &has_width, &ignored_width, &has_height,
                                       &ignored_height, &has_box, &box);
  if (has_box && box.width > 0 && box.height > 0) return {box.width, box.height};
  RsvgRectangle ink{}, logical{};
  if (!rsvg_handle_get_geometry_for_element(handle, nullptr, &ink, &logical, nullptr))
    return Vec2::Zero();
  return {ink.width, ink.height};
}

// Whether anything may be mixed as a whole.
bool may_mix(std::string_view svg) {
  for (const char* word : {"opacity", "filter", "mask", "blend", "isolation"})
    if (svg.find(word) != svg.npos) return true;
  return false;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20 || c == '\t')
      out += c;
  }
  return out;
}

// As SVG's attributes.
std::string font_attributes(const FontWish& wish) {
  return fmt::format("font-family=\"{}\" font-weight=\"{}\" font-style=\"{}\"",
                     escaped(wish.family), wish.bold ? "bold" : "normal",
                     wish.italic ? "italic" : "normal");
}

// Its lines begin at x = 0 ("start"), or lie in the middle of it ("middle").
std::string text_element(const std::string& text, const FontWish& font, const LinearColor& color,
                         const char* anchor) {
  std::string element = fmt::format(
      "<text id=\"t\" xml:space=\"preserve\" text-anchor=\"{}\" font-size=\"{}\" "
      "fill=\"rgb({},{},{})\" {}>",
      anchor, kFontSize, linear_to_srgb8(color.r), linear_to_srgb8(color.g),
      linear_to_srgb8(color.b), font_attributes(font));
  std::size_t begin = 0;
  for (int line = 0; begin <= text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    element += fmt::format("<tspan x=\"0\" y=\"{}\">{}</tspan>", line * kLineSpacing * kFontSize,
                           escaped(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  return element + "</text>";
}

std::string svg_around(const std::string& element, const RsvgRectangle& box) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{2}\" height=\"{3}\" "
      "viewBox=\"{0} {1} {2} {3}\">{4}</svg>",
      box.x, box.y, box.width, box.height, element);
}

// Where its ink lies, with some room around; nothing if there is nothing to see.
std::optional<RsvgRectangle> ink_of(const std::string& element, const std::string& name) {
  std::string why;
  // Around the origin, so large that no line reaches its edge.
  constexpr double kRoom = 1000 * kFontSize;
  const RsvgRectangle whole{-kRoom, -kRoom, 2 * kRoom, 2 * kRoom};
  const Owned<RsvgHandle> measured = parse(svg_around(element, whole), why, true);
  if (!measured) throw InputError(fmt::format("{} cannot be set: {}.", name, why));
  const RsvgRectangle viewport{0, 0, 2 * kRoom, 2 * kRoom};
  RsvgRectangle ink{}, logical{};
  if (!rsvg_handle_get_geometry_for_layer(measured.get(), "#t", &viewport, &ink, &logical,
                                          nullptr) ||
      !(ink.width > 0 && ink.height > 0))
    return {};
  return RsvgRectangle{ink.x - kRoom - kTextPad, ink.y - kRoom - kTextPad, ink.width + 2 * kTextPad,
                       ink.height + 2 * kTextPad};
}

Owned<cairo_surface_t> blank_surface(int width, int height) {
  Owned<cairo_surface_t> surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  return surface;
}

// cairo's pixels are premultiplied, blue first in memory on the machines that we know.
void make_straight(const unsigned char* row, int width, std::uint8_t* out) {
  for (int x = 0; x < width; ++x, row += 4, out += 4) {
    const auto pixel = *reinterpret_cast<const std::uint32_t*>(row);
    const std::uint32_t alpha = pixel >> 24U;
    out[3] = std::uint8_t(alpha);
    for (unsigned c = 0; c < 3; ++c) {
      const std::uint32_t value = (pixel >> (16U - 8U * c)) & 0xffU;
      out[c] = alpha == 0 ? 0 : std::uint8_t(std::min(255U, (value * 255U + alpha / 2) / alpha));
    }
  }
}

// What "data:..." stands for; empty if it is damaged.
std::vector<std::uint8_t> bytes_behind(const std::string& data) {
  struct Free {
    void operator()(guchar* bytes) const { g_free(bytes); }
    void operator()(GBytes* bytes) const { g_bytes_unref(bytes); }
  };
  const std::size_t comma = data.find(',');
  if (comma == std::string::npos) return {};
  const std::string coded = data.substr(comma + 1);
  gsize size = 0;
  if (data.rfind("base64", comma) != std::string::npos) {
    const std::unique_ptr<guchar, Free> bytes(g_base64_decode(coded.c_str(), &size));
    return {bytes.get(), bytes.get() + size};
  }
  const std::unique_ptr<GBytes, Free> bytes(
      g_uri_unescape_bytes(coded.data(), gssize(coded.size()), nullptr, nullptr));
  if (!bytes) return {};
  const auto* begin = static_cast<const std::uint8_t*>(g_bytes_get_data(bytes.get(), &size));
  return {begin, begin + size};
}

// Read without librsvg: there is hardly anything to see of it.
bool is_transparent_picture(const std::string& data) {
  constexpr double kHardly = 0.1;
  const std::vector<std::uint8_t> bytes = bytes_behind(data);
  try {
    if (looks_like_svg(bytes)) {
      std::string ignored;
      const std::vector<std::uint8_t> svg = unpacked_svg(bytes, "a drawing in it");
      const std::string_view text(reinterpret_cast<const char*>(svg.data()), svg.size());
      return parse(text, ignored, true) != nullptr;
    }
    const Image image = decode_image(bytes, "a picture in it");
    double seen = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) seen += image.rgba[i] > 0 ? 1 : 0;
    return 4 * seen < kHardly * double(image.rgba.size());
  } catch (const InputError&) {
    return false;
  }
}

// Whether librsvg shows a picture, given as "data:...": tried, as which kinds it reads hangs on the
// machine. Nothing seen may also be a picture that is transparent, if it can be read at all.
bool shows_picture(const std::string& data) {
  constexpr int kSide_px = 32;
  std::string why;
  const Owned<RsvgHandle> handle = parse(
      svg_around(fmt::format("<image width=\"{0}\" height=\"{0}\" preserveAspectRatio=\"none\" "
                             "href=\"{1}\"/>",
                             kSide_px, escaped(data)),
                 {0, 0, kSide_px, kSide_px}),
      why, false);
  if (!handle) return false;
  const Owned<cairo_surface_t> surface = blank_surface(kSide_px, kSide_px);
  const Owned<cairo_t> cairo(cairo_create(surface.get()));
  const RsvgRectangle all{0, 0, kSide_px, kSide_px};
  if (!rsvg_handle_render_document(handle.get(), cairo.get(), &all, nullptr)) return false;
  cairo_surface_flush(surface.get());
  const unsigned char* begin = cairo_image_surface_get_data(surface.get());
  const unsigned char* end = begin + kSide_px * cairo_image_surface_get_stride(surface.get());
  return std::any_of(begin, end, [](unsigned char byte) { return byte != 0; }) ||
         is_transparent_picture(data);
}

// A drawing in the drawing that needs libxml2's limits, or may have one in it that does.
bool may_multiply(const std::vector<std::uint8_t>& bytes) {
  if (!looks_like_svg(bytes)) return false;
  try {
    const std::vector<std::uint8_t> svg = unpacked_svg(bytes, "a drawing in it");
    const std::string_view text(reinterpret_cast<const char*>(svg.data()), svg.size());
    return declares_entities(text) || text.find("svg+xml") != text.npos;
  } catch (const InputError&) {
    return true;
  }
}

std::string data_of_png(const Image& image) {
  struct Free {
    void operator()(gchar* text) const { g_free(text); }
  };
  const std::vector<std::uint8_t> png = encode_png(image);
  const std::unique_ptr<gchar, Free> coded(g_base64_encode(png.data(), png.size()));
  return std::string("data:image/png;base64,") + coded.get();
}

// librsvg goes by pixels alone. Pictures whose files say more, as a colour profile, are read as
// those are that are given by themselves, and stand in the drawing as plain PNG.
class PicturesInDrawing {
 public:
  explicit PicturesInDrawing(std::string name) : name_(std::move(name)) {}

  // Whether a picture is shown, or it was told why not.
  bool shows(const std::string& data) {
    ++count_;
    if (instead_.contains(data)) return true;
    const std::vector<std::uint8_t> bytes = bytes_behind(data);
    if (may_multiply(bytes)) {
      instead_[data] = "data:,";
      return false;
    }
    return says_more_than_pixels(bytes) ? reads(data, bytes) : shows_picture(data);
  }

  // Of those that are read here: what stands in their place.
  const std::map<std::string, std::string>& instead() const { return instead_; }

 private:
  bool reads(const std::string& data, const std::vector<std::uint8_t>& bytes) {
    constexpr std::size_t kMostBytes = std::size_t(1) << 30U;
    const std::string name = fmt::format("{}, picture {}", name_, count_);
    std::string& made = instead_[data] = "data:,";
    try {
      made = data_of_png(decode_image(bytes, name));
    } catch (const InputError& error) {
      warn(fmt::format("{} It is not shown.", error.what()));
      return true;
    }
    bytes_ += made.size();
    if (bytes_ > kMostBytes)
      throw InputError(
          fmt::format("{}: the pictures in the drawing have more than {:.0f} MB; scale them down.",
                      name_, double(kMostBytes) / 1e6));
    return shows_picture(made);
  }

  std::string name_;
  int count_ = 0;
  std::size_t bytes_ = 0;
  std::map<std::string, std::string> instead_;
};

}  // namespace

struct Drawing::Impl {
  Owned<RsvgHandle> handle;
  Vec2 size;
  std::string name;

  bool is_text = false;  // of letters alone
  SvgContents contents;  // of an SVG drawing
  bool is_indivisible = false;
  double most_scale = 1e300;  // pixels per unit

  static std::unique_ptr<Impl> of_letters(const std::string& element, const RsvgRectangle& ink,
                                          const std::string& name);

  // A part of the drawing as large as `whole`, from its left upper corner on; false with a reason.
  bool draw(cairo_surface_t* surface, const Vec2& whole, int left, int top,
            std::string& why) const {
    const Owned<cairo_t> cairo(cairo_create(surface));
    cairo_translate(cairo.get(), -left, -top);
    const Vec2 scale = whole.cwiseQuotient(size);
    check_cancelled();
    // librsvg sets lines too long or too short where the two directions differ.
    if (is_stretched(whole) && (is_text || contents.has_text))
      return draw_stretched(cairo.get(), scale, why);
    if (is_text) {
      const double both = scale.minCoeff();
      const Vec2 rim = 0.5 * (whole - both * size);
      cairo_translate(cairo.get(), rim.x(), rim.y());
      cairo_scale(cairo.get(), both, both);
    } else {
      // One factor for both directions would leave a strip of a rounded size blank.
      cairo_scale(cairo.get(), scale.x(), scale.y());
    }
    return render(cairo.get(), why);
  }

  // Empty, with a reason, if it cannot be drawn.
  Image part(const Vec2& whole, int left, int top, int width, int height, std::string& why) const {
    const Owned<cairo_surface_t> surface = blank_surface(width, height);
    if (!draw(surface.get(), whole, left, top, why)) return {};
    cairo_surface_flush(surface.get());
    const unsigned char* data = cairo_image_surface_get_data(surface.get());
    const auto stride = std::size_t(cairo_image_surface_get_stride(surface.get()));
    Image image(width, height);
    for (int y = 0; y < height; ++y)
      make_straight(data + std::size_t(y) * stride, width, image.pixel(0, y));
    return image;
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(
        fmt::format("{}: the drawing cannot be drawn ({}); save it again.", name, why));
  }

  // librsvg draws whatever is mixed as a whole (opacity, blending, filters, masks) as large as the
  // drawing, whichever part is asked for, and fails where cairo has no such surface.
  bool can_be_drawn_in_parts() const {
    const Owned<cairo_surface_t> pixel = blank_surface(1, 1);
    std::string ignored;
    return draw(pixel.get(), size * (1.25 * kLongestSide_px / size.maxCoeff()), 0, 0, ignored);
  }

 private:
  // By more than a size in whole pixels has to be.
  bool is_stretched(const Vec2& whole) const {
    const Vec2 scale = whole.cwiseQuotient(size);
    return std::abs(scale.x() * size.y() - whole.y()) >= 1 &&
           std::abs(scale.y() * size.x() - whole.x()) >= 1;
  }

  // Set at one scale for both directions, the larger one, and then pressed together.
  bool draw_stretched(cairo_t* cairo, const Vec2& scale, std::string& why) const {
    const Owned<cairo_surface_t> lines(
        cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
    const Owned<cairo_t> setting(cairo_create(lines.get()));
    const double both = scale.maxCoeff();
    cairo_scale(setting.get(), both, both);
    if (!render(setting.get(), why)) return false;
    cairo_scale(cairo, scale.x() / both, scale.y() / both);
    cairo_set_source_surface(cairo, lines.get(), 0, 0);
    cairo_paint(cairo);
    const cairo_status_t status = cairo_status(cairo);
    if (status != CAIRO_STATUS_SUCCESS) why = cairo_status_to_string(status);
    return status == CAIRO_STATUS_SUCCESS;
  }

  bool render(cairo_t* cairo, std::string& why) const {
    const RsvgRectangle all{0, 0, size.x(), size.y()};
    GError* error = nullptr;
    if (rsvg_handle_render_document(handle.get(), cairo, &all, &error)) return true;
    why = message_of(error);
    return false;
  }
};

Drawing::Drawing(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Drawing::~Drawing() = default;
Drawing::Drawing(Drawing&&) noexcept = default;
Drawing& Drawing::operator=(Drawing&&) noexcept = default;

Drawing Drawing::from_svg(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  std::string why;
  const std::vector<std::uint8_t> svg = unpacked_svg(bytes, name);
  const std::string_view text(reinterpret_cast<const char*>(svg.data()), svg.size());
  auto impl = std::make_unique<Impl>();
  impl->name = name;
  impl->handle = parse(text, why, true);
  if (!impl->handle && !declares_entities(text)) impl->handle = parse(text, why, false);
  if (!impl->handle)
    throw InputError(
        fmt::format("{}: damaged or truncated SVG drawing ({}); save it again.", name, why));
  PicturesInDrawing pictures(name);
  impl->contents = contents_of(text, [&](const std::string& data) { return pictures.shows(data); });
  if (!pictures.instead().empty()) {
    // Of what was within the limits, or needs none.
    impl->handle = parse(with_pictures(text, pictures.instead()), why, false);
    if (!impl->handle) impl->refuse(why);
  }
  if (impl->contents.has_text) require_fonts(name);
  impl->size = natural_size(impl->handle.get());
  if (!(impl->size.minCoeff() > 0) || !impl->size.allFinite())
    throw InputError(fmt::format(
        "{}: the SVG drawing has no size and nothing to see; give it a width and height, or a "
        "viewBox.",
        name));
  // Letters of such a size may be none that can be drawn.
  impl->is_indivisible = impl->contents.has_text ? may_mix(text) : !impl->can_be_drawn_in_parts();
  return Drawing(std::move(impl));
}

std::unique_ptr<Drawing::Impl> Drawing::Impl::of_letters(const std::string& element,
                                                         const RsvgRectangle& ink,
                                                         const std::string& name) {
  std::string why;
  auto impl = std::make_unique<Impl>();
  impl->name = name;
  impl->handle = parse(svg_around(element, ink), why, true);
  if (!impl->handle) throw InputError(fmt::format("{} cannot be set: {}.", name, why));
  impl->size = {ink.width, ink.height};
  impl->is_text = true;
  impl->most_scale = kLargestLetter_px / kFontSize;
  return impl;
}

Drawing Drawing::from_text(const std::string& text, const std::string& font,
                           const LinearColor& color) {
  const std::string name = "the text '" + text + "'";
  require_fonts(name);
  const std::string element = text_element(text, parse_font(font), color, "middle");
  const std::optional<RsvgRectangle> ink = ink_of(element, name);
  if (!ink) throw InputError(name + " shows nothing: write letters");
  return Drawing(Impl::of_letters(element, *ink, name));
}

std::optional<DrawnLine> Drawing::of_line(const std::string& text, const std::string& font) {
  const std::string name = "the text '" + text + "'";
  require_fonts(name);
  const std::string element = text_element(text, parse_font(font), {}, "start");
  const std::optional<RsvgRectangle> ink = ink_of(element, name);
  if (!ink) return {};
  const Vec2 left_top = Vec2(ink->x, ink->y) / kFontSize;
  const Vec2 size = Vec2(ink->width, ink->height) / kFontSize;
  return DrawnLine{
      Drawing(Impl::of_letters(element, *ink, name)),
      {Vec2(left_top.x(), -left_top.y() - size.y()), Vec2(left_top.x() + size.x(), -left_top.y())}};
}

double Drawing::aspect() const { return impl_->size.x() / impl_->size.y(); }

double Drawing::natural_width_mm() const {
  gboolean has_width = FALSE, has_height = FALSE, has_box = FALSE;
  RsvgLength width{}, height{};
  RsvgRectangle box{};
  rsvg_handle_get_intrinsic_dimensions(impl_->handle.get(), &has_width, &width, &has_height,
                                       &height, &has_box, &box);
  if (impl_->is_text || !has_width || !(width.length > 0)) return 0;
  switch (width.unit) {
    case RSVG_UNIT_MM:
      return width.length;
    case RSVG_UNIT_CM:
      return 10 * width.length;
    case RSVG_UNIT_IN:
      return kMmPerInch * width.length;
    case RSVG_UNIT_PT:
      return kMmPerInch * width.length / 72;
    case RSVG_UNIT_PC:
      return kMmPerInch * width.length / 6;
    default:
      return 0;
  }
}

const SvgContents& Drawing::contents() const { return impl_->contents; }

Drawing::Limits Drawing::limits() const {
  const double side_px = std::min(kMostPixels, impl_->most_scale * impl_->size.maxCoeff());
  if (impl_->is_indivisible) return {kMostPixelsAtOnce, std::min(side_px, kLongestSide_px)};
  return {kMostPixels, side_px};
}

Image Drawing::pixels(int width_px, int height_px) const {
  std::string why;
  Image image = impl_->part(Vec2(width_px, height_px), 0, 0, width_px, height_px, why);
  if (image.empty()) impl_->refuse(why);
  return image;
}

std::optional<TiledImage> Drawing::tiles(int width_px, int height_px,
                                         std::size_t most_bytes) const {
  // Small enough that a job that is cancelled ends soon.
  constexpr int kPart_px = 32 * TiledImage::kTile_px;
  const int width = impl_->is_indivisible ? width_px : std::min(width_px, kPart_px);
  const int height = impl_->is_indivisible ? height_px : std::min(height_px, kPart_px);
  TiledImage image(width_px, height_px);
  for (int top = 0; top < height_px; top += height)
    for (int left = 0; left < width_px; left += width) {
      std::string why;
      const Image part =
          impl_->part(Vec2(width_px, height_px), left, top, std::min(width, width_px - left),
                      std::min(height, height_px - top), why);
      if (part.empty() && std::max(width_px, height_px) > kSafeSide_px) return {};
      if (part.empty()) impl_->refuse(why);
      image.put(part, left, top);
      if (image.bytes() > most_bytes) return {};
    }
  return image;
}

}  // namespace hydrodip
