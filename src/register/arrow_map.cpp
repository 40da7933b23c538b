#include "register/arrow_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/canvas.h"

namespace hydrodip {
namespace {

constexpr int kLongSide_px = 760, kMargin_px = 70, kHeader_px = 110;
constexpr double kLine_px = 22;
// The longest arrow: over the sheet, and over the distance of its neighbours.
constexpr double kLongest = 0.06, kOfSpacing = 0.7;
constexpr LinearColor kSheet{1, 1, 1, 1}, kEdge{0.35F, 0.36F, 0.4F, 1},
    kTape{0.82F, 0.83F, 0.85F, 1};
constexpr LinearColor kInk{0.55F, 0.02F, 0.02F, 1};

// A line so many pixels wide, its edges softened.
void draw_stroke(Image& page, const Vec2& from, const Vec2& to, double width_px) {
  const Vec2 way = to - from;
  const double length = way.norm();
  const int x0 = int(std::min(from.x(), to.x()) - width_px - 1),
            x1 = int(std::max(from.x(), to.x()) + width_px + 2),
            y0 = int(std::min(from.y(), to.y()) - width_px - 1),
            y1 = int(std::max(from.y(), to.y()) + width_px + 2);
  for (int y = std::max(0, y0); y < std::min(page.height_px, y1); ++y)
    for (int x = std::max(0, x0); x < std::min(page.width_px, x1); ++x) {
      const Vec2 at = Vec2(x + 0.5, y + 0.5) - from;
      const double along = length > 0 ? std::clamp(at.dot(way) / (length * length), 0.0, 1.0) : 0;
      const double cover = std::clamp(0.5 * width_px + 0.5 - (at - along * way).norm(), 0.0, 1.0);
      if (!(cover > 0)) continue;
      std::uint8_t* pixel = page.pixel(x, y);
      const float ink[3] = {kInk.r, kInk.g, kInk.b};
      for (int k = 0; k < 3; ++k)
        pixel[k] =
            linear_to_srgb8(srgb8_to_linear(pixel[k]) * float(1 - cover) + ink[k] * float(cover));
    }
}

void draw_arrow(Image& page, const Vec2& from, const Vec2& to) {
  draw_stroke(page, from, from, 5);
  const Vec2 way = to - from;
  const double length = way.norm();
  if (length < 1.5) return;
  draw_stroke(page, from, to, 1.8);
  const double head = std::min(9.0, 0.5 * length);
  const Vec2 back = -way / length * head;
  for (const double side : {-0.45, 0.45})
    draw_stroke(page, to, to + back + side * Vec2(-back.y(), back.x()), 1.8);
}

// Of the two that stand nearest to each other; on a grid, the first ones tell.
double closest_mm(const std::vector<Arrow>& arrows) {
  double nearest = 1e300;
  constexpr std::size_t kFirst = 100;
  for (std::size_t i = 0; i < std::min(kFirst, arrows.size()); ++i)
    for (std::size_t j = i + 1; j < arrows.size(); ++j) {
      const double distance = (arrows[i].from_mm - arrows[j].from_mm).norm();
      if (distance > 0) nearest = std::min(nearest, distance);
    }
  return nearest;
}

double largest(const std::vector<Arrow>& arrows) {
  double most = 0;
  for (const Arrow& arrow : arrows) most = std::max(most, arrow.by_mm.norm());
  return most;
}

// 1, 2 or 5 times a power of ten, not above.
double round_down(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

}  // namespace

Image draw_arrow_map(double width_mm, double height_mm, double margin_mm,
                     const std::vector<Arrow>& arrows, const std::string& title,
                     const std::vector<std::string>& lines) {
  const double scale = kLongSide_px / std::max(width_mm, height_mm);
  const int width = int(width_mm * scale), height = int(height_mm * scale);
  const int page_width = std::max(width + 2 * kMargin_px, 560);
  Image page =
      blank_page(page_width, kHeader_px + height + int(kLine_px * (double(lines.size()) + 6.5)));
  draw_centered(page, title, 0.5 * page_width, 40, text_style(22, kTitleInk));
  const int left = (page_width - width) / 2;
  fill(page, left - 1, kHeader_px - 1, left + width + 1, kHeader_px + height + 1, kEdge);
  fill(page, left, kHeader_px, left + width, kHeader_px + height, kTape);
  const int tape = int(std::lround(margin_mm * scale));
  fill(page, left + tape, kHeader_px + tape, left + width - tape, kHeader_px + height - tape,
       kSheet);
  const Vec2 middle(left + 0.5 * width, kHeader_px + 0.5 * height);
  const auto to_px = [&](const Vec2& mm) -> Vec2 { return middle + scale * Vec2(mm.x(), -mm.y()); };
  const double most = largest(arrows);
  const double longest_mm =
      std::min(kLongest * std::max(width_mm, height_mm), kOfSpacing * closest_mm(arrows));
  const double longer = most > 0 ? longest_mm / most : 1;
  for (const Arrow& arrow : arrows)
    draw_arrow(page, to_px(arrow.from_mm), to_px(arrow.from_mm + longer * arrow.by_mm));
  double y = kHeader_px + height + 3.2 * kLine_px;
  if (most > 0) {
    const double shown = round_down(most);
    const double length = shown * longer * scale;
    const double end = 0.5 * page_width - 60;
    draw_stroke(page, {end - length, y - 5}, {end, y - 5}, 2);
    draw_centered(page, fmt::format("{:g} mm", shown), 0.5 * page_width, y,
                  text_style(16, kLabelInk));
    y += kLine_px;
    draw_centered(page, fmt::format("arrows are drawn {:.2g} times as long as true", longer),
                  0.5 * page_width, y, text_style(16, kLabelInk));
    y += kLine_px;
  }
  for (const std::string& line : lines) {
    draw_centered(page, line, 0.5 * page_width, y, text_style(16, kLabelInk));
    y += kLine_px;
  }
  return page;
}

}  // namespace hydrodip
