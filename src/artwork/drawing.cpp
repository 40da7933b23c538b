#include "artwork/drawing.h"

#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

struct Unref {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(GError* error) const { g_error_free(error); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
template <class Type>
using Owned = std::unique_ptr<Type, Unref>;

constexpr double kFontSize = 100;
constexpr double kLineSpacing = 1.2;
// Around the letters, so that no outline is cut.
constexpr double kTextPad = 1;

std::string message_of(GError* error) {
  const Owned<GError> owned(error);
  return owned && owned->message ? owned->message : "no reason given";
}

// Null with a reason.
Owned<RsvgHandle> parse(std::string_view text, std::string& why) {
  GError* error = nullptr;
  Owned<RsvgHandle> handle(rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(text.data()),
                                                     gsize(text.size()), &error));
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

bool take_last_word(std::string& text, std::string_view word) {
  if (text.size() < word.size() || !text.ends_with(word)) return false;
  const std::size_t rest = text.size() - word.size();
  if (rest > 0 && text[rest - 1] != ' ') return false;
  text.resize(rest > 0 ? rest - 1 : 0);
  return true;
}

// "DejaVu Serif bold italic" as SVG's attributes.
std::string font_attributes(std::string font) {
  bool bold = false, italic = false;
  for (bool found = true; found;) {
    found = take_last_word(font, "bold");
    bold |= found;
    const bool slanted = take_last_word(font, "italic");
    italic |= slanted;
    found |= slanted;
  }
  if (font.empty()) font = "sans";
  if (font == "sans") font = "sans-serif";
  return fmt::format("font-family=\"{}\" font-weight=\"{}\" font-style=\"{}\"", escaped(font),
                     bold ? "bold" : "normal", italic ? "italic" : "normal");
}

std::string text_element(const std::string& text, const std::string& font,
                         const LinearColor& color) {
  std::string element = fmt::format(
      "<text id=\"t\" xml:space=\"preserve\" text-anchor=\"middle\" font-size=\"{}\" "
      "fill=\"rgb({},{},{})\" {}>",
      kFontSize, linear_to_srgb8(color.r), linear_to_srgb8(color.g), linear_to_srgb8(color.b),
      font_attributes(font));
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

}  // namespace

struct Drawing::Impl {
  Owned<RsvgHandle> handle;
  Vec2 size;
  std::string name;

  // Rows from `top` on.
  void draw(Image& image, int top, int rows) const {
    const Owned<cairo_surface_t> surface(
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width_px, rows));
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
    const Owned<cairo_t> cairo(cairo_create(surface.get()));
    cairo_translate(cairo.get(), 0, -top);
    // One factor for both directions would leave a strip of a rounded size blank.
    cairo_scale(cairo.get(), image.width_px / size.x(), image.height_px / size.y());
    const RsvgRectangle all{0, 0, size.x(), size.y()};
    GError* error = nullptr;
    check_cancelled();
    if (!rsvg_handle_render_document(handle.get(), cairo.get(), &all, &error))
      throw InputError(fmt::format("{}: the drawing cannot be drawn ({}); save it again.", name,
                                   message_of(error)));
    cairo_surface_flush(surface.get());
    const unsigned char* data = cairo_image_surface_get_data(surface.get());
    const auto stride = std::size_t(cairo_image_surface_get_stride(surface.get()));
    for (int y = 0; y < rows; ++y)
      make_straight(data + std::size_t(y) * stride, image.width_px, image.pixel(0, top + y));
  }
};

Drawing::Drawing(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Drawing::~Drawing() = default;
Drawing::Drawing(Drawing&&) noexcept = default;
Drawing& Drawing::operator=(Drawing&&) noexcept = default;

Drawing Drawing::from_svg(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  std::string why;
  auto impl = std::make_unique<Impl>();
  impl->name = name;
  impl->handle = parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, why);
  if (!impl->handle)
    throw InputError(
        fmt::format("{}: damaged or truncated SVG drawing ({}); save it again.", name, why));
  impl->size = natural_size(impl->handle.get());
  if (!(impl->size.minCoeff() > 0) || !impl->size.allFinite())
    throw InputError(fmt::format(
        "{}: the SVG drawing has no size and nothing to see; give it a width and height, or a "
        "viewBox.",
        name));
  return Drawing(std::move(impl));
}

Drawing Drawing::from_text(const std::string& text, const std::string& font,
                           const LinearColor& color) {
  const std::string element = text_element(text, font, color);
  const std::string name = "the text '" + text + "'";
  std::string why;
  // Around the origin, so large that no line reaches its edge.
  constexpr double kRoom = 1e5;
  const RsvgRectangle whole{-kRoom, -kRoom, 2 * kRoom, 2 * kRoom};
  const Owned<RsvgHandle> measured = parse(svg_around(element, whole), why);
  if (!measured) throw InputError(fmt::format("{} cannot be set: {}.", name, why));
  const RsvgRectangle viewport{0, 0, 2 * kRoom, 2 * kRoom};
  RsvgRectangle ink{}, logical{};
  if (!rsvg_handle_get_geometry_for_layer(measured.get(), "#t", &viewport, &ink, &logical,
                                          nullptr) ||
      !(ink.width > 0 && ink.height > 0))
    throw InputError(name +
                     " shows nothing: write letters, and see to it that fonts are installed");
  ink.x -= kRoom;
  ink.y -= kRoom;
  ink = {ink.x - kTextPad, ink.y - kTextPad, ink.width + 2 * kTextPad, ink.height + 2 * kTextPad};
  auto impl = std::make_unique<Impl>();
  impl->name = name;
  impl->handle = parse(svg_around(element, ink), why);
  if (!impl->handle) throw InputError(fmt::format("{} cannot be set: {}.", name, why));
  impl->size = {ink.width, ink.height};
  return Drawing(std::move(impl));
}

double Drawing::aspect() const { return impl_->size.x() / impl_->size.y(); }

Image Drawing::pixels(int width_px, int height_px) const {
  // In bands, so that memory holds the picture once.
  constexpr int kBand_px = 1024;
  Image image(width_px, height_px);
  for (int top = 0; top < height_px; top += kBand_px)
    impl_->draw(image, top, std::min(kBand_px, height_px - top));
  return image;
}

bool looks_like_svg(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kLooked = 4096;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                              std::min(bytes.size(), kLooked));
  const std::size_t start = text.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return start != std::string_view::npos && text[start] == '<' &&
         text.find("<svg") != std::string_view::npos;
}

}  // namespace hydrodip
