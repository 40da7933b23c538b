#include "render/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <vector>

#include "base/math.h"

namespace hydrodip {
namespace {

// Font units: baseline y = 0, small letters 5 high, capitals 7, descenders to -2.
constexpr double kCapHeight = 7;
constexpr double kLetterSpacing = 1.55;

// Strokes: "l x y x y ..." a polyline (one repeated point: a dot), "a cx cy rx ry from to" an arc
// of an ellipse, degrees counter-clockwise. They are separated by semicolons.
struct GlyphSource {
  double width;
  const char* strokes;
};

#define BOWL "a 2.2 2.5 2.2 2.5 0 360"

// Printable ASCII, from the space on.
constexpr std::array<GlyphSource, 95> kAscii = {{
    {1.2, ""},
    {0, "l 0 7 0 2.1;l 0 0.1 0 0.1"},
    {1.4, "l 0 7 0 5;l 1.4 7 1.4 5"},
    {5, "l 1.7 7 0.9 0;l 4.1 7 3.3 0;l 0.3 4.7 5 4.7;l 0 2.3 4.7 2.3"},
    {4.2, "a 2.1 4.8 2 1.4 30 270;a 2.1 2 2.1 1.4 90 -150;l 2.1 7.6 2.1 -0.8"},
    {6.4, "l 5.4 7 1 0;a 1.4 5.5 1.4 1.5 0 360;a 5 1.5 1.4 1.5 0 360"},
    {5.6,
     "l 5.4 0 1.3 4.8;a 2.3 5.5 1.35 1.5 -150 -360;a 2.3 5.5 1.35 1.5 0 -15;"
     "a 2.3 5.5 1.35 1.5 180 210;l 3.55 4.9 0.9 3.1;a 2.1 1.9 2.1 1.9 125 360;"
     "l 4.2 1.9 4.9 3.5"},
    {0, "l 0 7 0 5"},
    {1.6, "a 4 3 4 4.8 120 240"},
    {1.6, "a -2.4 3 4 4.8 60 -60"},
    {3.2, "l 1.6 7 1.6 3.8;l 0.2 6.2 3 4.6;l 3 6.2 0.2 4.6"},
    {4.2, "l 2.1 5.6 2.1 1.4;l 0 3.5 4.2 3.5"},
    {0.4, "l 0.4 0.2 0 -1.2"},
    {2.4, "l 0 2.7 2.4 2.7"},
    {0, "l 0 0.1 0 0.1"},
    {3.2, "l 3.2 7.6 0 -1"},
    {4.2, "a 2.1 3.5 2.1 3.5 0 360"},
    {4.2, "l 0.8 5.7 2.5 7 2.5 0"},
    {4.2, "a 2.1 5 1.9 2 165 -38;l 3.6 3.77 0.2 0 4.1 0"},
    {4.2, "a 2 5.3 1.8 1.7 150 -90;a 2 1.8 2.1 1.8 90 -155"},
    {4.2, "l 3.2 0 3.2 7 0 2 4.3 2"},
    {4.2, "l 3.8 7 0.8 7 0.43 3.78;a 2 2.25 2.15 2.25 137 -150"},
    {4.2, "a 2.1 2.2 2.1 2.2 0 360;a 4.6 2.2 4.6 4.8 105 180"},
    {4.2, "l 0 7 4.2 7 1.4 0"},
    {4.2, "a 2.1 5.3 1.75 1.7 0 360;a 2.1 1.8 2.1 1.8 0 360"},
    {4.2, "a 2.1 4.8 2.1 2.2 0 360;a -0.4 4.8 4.6 4.8 -75 0"},
    {0, "l 0 0.1 0 0.1;l 0 4.6 0 4.6"},
    {0.4, "l 0.4 0.2 0 -1.2;l 0.4 4.6 0.4 4.6"},
    {4.2, "l 4.2 5.9 0 3.5 4.2 1.1"},
    {4.2, "l 0 4.5 4.2 4.5;l 0 2.5 4.2 2.5"},
    {4.2, "l 0 5.9 4.2 3.5 0 1.1"},
    {3.6, "a 1.8 5.2 1.8 1.8 165 -60;a 3.3 2.1 1.5 1.7 125 180;l 1.8 0.1 1.8 0.1"},
    {7.2,
     "a 3.6 2.6 1.6 1.9 0 360;l 5.2 4.5 5.2 2.2;a 6.2 2.2 1 1.4 180 350;"
     "a 3.6 2.6 3.6 4.2 -5 300"},
    {5.4, "l 0 0 2.7 7 5.4 0;l 0.93 2.4 4.47 2.4"},
    {4.5,
     "l 2.3 3.6 0 3.6;l 2.6 0 0 0 0 7 2.3 7;a 2.3 5.3 1.7 1.7 90 -90;"
     "l 2.3 3.6 2.6 3.6;a 2.6 1.8 1.9 1.8 90 -90"},
    {5.5, "a 3.2 3.5 3.2 3.5 48 312"},
    {5.4, "l 2 0 0 0 0 7 2 7;a 2 3.5 3.4 3.5 90 -90"},
    {4, "l 4 7 0 7 0 0 4 0;l 0 3.6 3.6 3.6"},
    {4, "l 4 7 0 7 0 0;l 0 3.6 3.5 3.6"},
    {6.4, "a 3.2 3.5 3.2 3.5 48 360;l 6.4 3.5 3.6 3.5"},
    {5, "l 0 0 0 7;l 5 0 5 7;l 0 3.6 5 3.6"},
    {0, "l 0 0 0 7"},
    {3, "l 3 7 3 2;a 1.5 2 1.5 2 0 -155"},
    {4.7, "l 0 0 0 7;l 4.5 7 0 2.6;l 1.6 4.15 4.8 0"},
    {3.8, "l 0 7 0 0 3.8 0"},
    {6, "l 0 0 0 7 3 1.5 6 7 6 0"},
    {5, "l 0 0 0 7 5 0 5 7"},
    {6.8, "a 3.4 3.5 3.4 3.5 0 360"},
    {4.4, "l 0 0 0 7 2.5 7;a 2.5 5.1 1.9 1.9 90 -90;l 2.5 3.2 0 3.2"},
    {6.8, "a 3.4 3.5 3.4 3.5 0 360;l 4.2 1.8 6.6 -0.6"},
    {4.6, "l 0 0 0 7 2.5 7;a 2.5 5.1 1.9 1.9 90 -90;l 2.5 3.2 0 3.2;l 2.2 3.2 4.6 0"},
    {4.4, "a 2.2 5.2 2.05 1.8 30 270;a 2.2 1.7 2.2 1.7 90 -150"},
    {5, "l 0 7 5 7;l 2.5 7 2.5 0"},
    {5, "l 0 7 0 2.5;a 2.5 2.5 2.5 2.5 180 360;l 5 2.5 5 7"},
    {5.4, "l 0 7 2.7 0 5.4 7"},
    {8, "l 0 7 2 0 4 6.4 6 0 8 7"},
    {4.8, "l 0 7 4.8 0;l 4.8 7 0 0"},
    {5, "l 0 7 2.5 3.4 5 7;l 2.5 3.4 2.5 0"},
    {4.8, "l 0 7 4.8 7 0 0 4.8 0"},
    {1.6, "l 1.6 7.6 0 7.6 0 -1.6 1.6 -1.6"},
    {3.2, "l 0 7.6 3.2 -1"},
    {1.6, "l 0 7.6 1.6 7.6 1.6 -1.6 0 -1.6"},
    {3.6, "l 0 4.6 1.8 7 3.6 4.6"},
    {4.4, "l 0 -1.2 4.4 -1.2"},
    {1, "l 0 7.2 1 6"},
    {4.4, BOWL ";l 4.4 5 4.4 0"},
    {4.4, BOWL ";l 0 7 0 0"},
    {3.9, "a 2.2 2.5 2.2 2.5 47 313"},
    {4.4, BOWL ";l 4.4 7 4.4 0"},
    {4.4, "l 0.1 2.5 4.4 2.5;a 2.2 2.5 2.2 2.5 0 315"},
    {2.6, "a 2.4 5.5 1.5 1.5 70 180;l 0.9 5.5 0.9 0;l 0 4.7 2.5 4.7"},
    {4.4, BOWL ";l 4.4 5 4.4 0.2;a 2.2 0.2 2.2 2.2 0 -150"},
    {4, "l 0 7 0 0;a 2 2.9 2 2.1 180 0;l 4 2.9 4 0"},
    {0, "l 0 5 0 0;l 0 6.8 0 6.8"},
    {1.1, "l 1.1 5 1.1 -0.8;a -0.1 -0.8 1.2 1.2 0 -75;l 1.1 6.8 1.1 6.8"},
    {3.7, "l 0 7 0 0;l 3.5 5 0 1.9;l 1.25 3 3.8 0"},
    {0, "l 0 7 0 0"},
    {6.6,
     "l 0 5 0 0;a 1.65 3.2 1.65 1.8 180 0;l 3.3 3.2 3.3 0;a 4.95 3.2 1.65 1.8 180 0;"
     "l 6.6 3.2 6.6 0"},
    {4, "l 0 5 0 0;a 2 2.9 2 2.1 180 0;l 4 2.9 4 0"},
    {4.5, "a 2.25 2.5 2.25 2.5 0 360"},
    {4.4, BOWL ";l 0 5 0 -2"},
    {4.4, BOWL ";l 4.4 5 4.4 -2"},
    {2.4, "l 0 5 0 0;a 2 2.9 2 2.1 180 75"},
    {3.5, "a 1.75 3.75 1.65 1.25 30 270;a 1.75 1.25 1.75 1.25 90 -150"},
    {2.6, "l 1 6.4 1 1.3;a 2.2 1.3 1.2 1.3 180 290;l 0 4.7 2.6 4.7"},
    {4, "l 0 5 0 2.1;a 2 2.1 2 2.1 180 360;l 4 5 4 0"},
    {4, "l 0 5 2 0 4 5"},
    {6, "l 0 5 1.5 0 3 4.6 4.5 0 6 5"},
    {3.8, "l 0 5 3.8 0;l 3.8 5 0 0"},
    {4, "l 0 5 2 0;l 4 5 1.2 -2"},
    {3.6, "l 0 5 3.6 5 0 0 3.6 0"},
    {2,
     "a 2 6.2 1.1 1.4 90 180;l 0.9 6.2 0.9 4;a 0 4 0.9 1 0 -90;a 0 2 0.9 1 90 0;"
     "l 0.9 2 0.9 -0.2;a 2 -0.2 1.1 1.4 180 270"},
    {0, "l 0 7.6 0 -1.6"},
    {2,
     "a 0 6.2 1.1 1.4 90 0;l 1.1 6.2 1.1 4;a 2 4 0.9 1 180 270;a 2 2 0.9 1 90 180;"
     "l 1.1 2 1.1 -0.2;a 0 -0.2 1.1 1.4 0 -90"},
    {4.2, "a 1.05 3 1.05 0.9 180 0;a 3.15 3 1.05 0.9 180 360"},
}};

#undef BOWL

constexpr GlyphSource kBox = {4, "l 0 0 0 7 4 7 4 0 0 0"};
constexpr GlyphSource kDegreeSign = {2, "a 1 6 1 1 0 360"};
constexpr GlyphSource kTimes = {3.4, "l 0 1.4 3.4 4.8;l 3.4 1.4 0 4.8"};
constexpr GlyphSource kSquared = {2.3, "a 1.1 6.3 1 1.1 165 -38;l 1.9 5.6 0.1 3.6 2.2 3.6"};
constexpr GlyphSource kDash = {4.4, "l 0 2.7 4.4 2.7"};
constexpr GlyphSource kMicro = {4, "l 0 5 0 -2;l 0 5 0 2.1;a 2 2.1 2 2.1 180 360;l 4 5 4 0"};

GlyphSource glyph_of(std::uint32_t code) {
  if (code >= 0x20 && code < 0x7f) return kAscii[code - 0x20];
  switch (code) {
    case 0x09:
    case 0xa0:
    case 0x202f:
      return kAscii[0];
    case 0xb0:
      return kDegreeSign;
    case 0xb2:
      return kSquared;
    case 0xb5:
      return kMicro;
    case 0xd7:
      return kTimes;
    case 0x2013:
    case 0x2014:
    case 0x2212:
      return kDash;
    case 0x2018:
    case 0x2019:
      return kAscii['\'' - 0x20];
    case 0x201c:
    case 0x201d:
      return kAscii['"' - 0x20];
    default:
      return kBox;
  }
}

// Code points of UTF-8 text; a byte that is not UTF-8 becomes the replacement character.
std::vector<std::uint32_t> code_points(const std::string& text) {
  std::vector<std::uint32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int more = lead < 0x80       ? 0
                     : lead >> 5 == 6  ? 1
                     : lead >> 4 == 14 ? 2
                     : lead >> 3 == 30 ? 3
                                       : -1;
    std::uint32_t code = more <= 0 ? lead : lead & (0x3fu >> more);
    bool whole = more >= 0 && i + std::size_t(more) < text.size();
    for (int k = 1; whole && k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + std::size_t(k)]);
      whole = (next & 0xc0) == 0x80;
      code = code << 6 | (next & 0x3fu);
    }
    codes.push_back(whole ? code : 0xfffd);
    i += whole ? std::size_t(more) + 1 : 1;
  }
  return codes;
}

std::string to_utf8(const std::vector<std::uint32_t>& codes) {
  std::string text;
  for (const std::uint32_t code : codes) {
    const int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static constexpr std::array<unsigned, 4> kLead = {0, 0xc0, 0xe0, 0xf0};
    text += static_cast<char>(kLead[std::size_t(more)] | code >> (6 * more));
    for (int k = more - 1; k >= 0; --k) text += static_cast<char>(0x80 | (code >> (6 * k) & 0x3f));
  }
  return text;
}

using Stroke = std::vector<Vec2>;

Stroke parse_stroke(const std::string& source) {
  std::istringstream in(source);
  char kind = 0;
  in >> kind;
  std::vector<double> n;
  for (double value = 0; in >> value;) n.push_back(value);
  Stroke stroke;
  if (kind == 'l') {
    for (std::size_t i = 0; i + 1 < n.size(); i += 2) stroke.emplace_back(n[i], n[i + 1]);
  } else if (n.size() == 6) {
    const int steps = std::max(2, int(std::ceil(std::abs(n[5] - n[4]) / 7.5)));
    for (int i = 0; i <= steps; ++i) {
      const double degrees = n[4] + (n[5] - n[4]) * i / steps;
      const double angle = degrees * std::numbers::pi / 180;
      stroke.emplace_back(n[0] + n[2] * std::cos(angle), n[1] + n[3] * std::sin(angle));
    }
  }
  return stroke;
}

std::vector<Stroke> parse_glyph(const char* strokes) {
  std::vector<Stroke> result;
  std::istringstream in(strokes);
  for (std::string part; std::getline(in, part, ';');) result.push_back(parse_stroke(part));
  return result;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

void blend(std::uint8_t* pixel, const LinearColor& color, double coverage) {
  const float alpha = float(coverage) * color.a;
  const std::array<float, 3> ink = {color.r, color.g, color.b};
  for (std::size_t c = 0; c < 3; ++c) {
    const float below = srgb8_to_linear(pixel[c]);
    pixel[c] = linear_to_srgb8(below + alpha * (ink[c] - below));
  }
}

// Fills the pixels whose centre is nearer to a stroke than half its width, with a soft edge one
// pixel wide.
void draw_glyph(Image& image, const std::vector<Stroke>& strokes, const TextStyle& style) {
  const double reach = 0.5 * style.weight * style.size_px + 0.5;
  Box2 box;
  for (const Stroke& stroke : strokes) {
    for (const Vec2& p : stroke) box.add(p);
  }
  if (box.empty()) return;
  const int x0 = std::max(0, int(std::floor(box.min.x() - reach - 1)));
  const int y0 = std::max(0, int(std::floor(box.min.y() - reach - 1)));
  const int x1 = std::min(image.width_px - 1, int(std::ceil(box.max.x() + reach + 1)));
  const int y1 = std::min(image.height_px - 1, int(std::ceil(box.max.y() + reach + 1)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Vec2 p(x + 0.5, y + 0.5);
      double nearest = 1e300;
      for (const Stroke& stroke : strokes) {
        for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
          nearest = std::min(nearest, distance_to_segment(p, stroke[i], stroke[i + 1]));
        }
      }
      const double coverage = std::clamp(reach - nearest, 0.0, 1.0);
      if (coverage > 0) blend(image.pixel(x, y), style.color, coverage);
    }
  }
}

double advance(const GlyphSource& glyph, const TextStyle& style) {
  return (glyph.width + kLetterSpacing) * style.size_px / kCapHeight;
}

}  // namespace

double text_width_px(const std::string& text, const TextStyle& style) {
  double width = 0;
  for (const std::uint32_t code : code_points(text)) width += advance(glyph_of(code), style);
  return std::max(0.0, width - kLetterSpacing * style.size_px / kCapHeight);
}

void draw_text(Image& image, const std::string& text, double x_px, double y_px,
               const TextStyle& style) {
  const double scale = style.size_px / kCapHeight;
  for (const std::uint32_t code : code_points(text)) {
    const GlyphSource glyph = glyph_of(code);
    std::vector<Stroke> strokes = parse_glyph(glyph.strokes);
    for (Stroke& stroke : strokes) {
      for (Vec2& p : stroke) p = Vec2(x_px + scale * p.x(), y_px - scale * p.y());
    }
    draw_glyph(image, strokes, style);
    x_px += advance(glyph, style);
  }
}

std::string fit_text(const std::string& text, const TextStyle& style, double max_width_px) {
  if (text_width_px(text, style) <= max_width_px) return text;
  std::vector<std::uint32_t> codes = code_points(text);
  codes.resize(std::min<std::size_t>(codes.size(), 1000));  // nobody's line is longer
  while (!codes.empty()) {
    codes.pop_back();
    while (!codes.empty() && codes.back() == ' ') codes.pop_back();
    std::string cut = to_utf8(codes) + "...";
    if (text_width_px(cut, style) <= max_width_px) return cut;
  }
  return "";
}

std::vector<std::string> fit_lines(const std::string& text, const TextStyle& style,
                                   double max_width_px, std::size_t most) {
  std::vector<std::string> lines;
  std::string rest = text;
  while (lines.size() + 1 < most && text_width_px(rest, style) > max_width_px) {
    std::size_t end = rest.rfind(' ');
    while (end != std::string::npos && end > 0 &&
           text_width_px(rest.substr(0, end), style) > max_width_px)
      end = rest.rfind(' ', end - 1);
    if (end == std::string::npos || end == 0) break;
    lines.push_back(rest.substr(0, end));
    rest = rest.substr(end + 1);
  }
  lines.push_back(fit_text(rest, style, max_width_px));
  return lines;
}

}  // namespace hydrodip
