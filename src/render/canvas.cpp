#include "render/canvas.h"

#include <algorithm>

namespace hydrodip {

Image blank_page(int width_px, int height_px) {
  Image page(width_px, height_px);
  for (std::size_t i = 0; i < page.rgba.size(); i += 4) {
    page.rgba[i] = page.rgba[i + 1] = page.rgba[i + 2] = 252;
    page.rgba[i + 3] = 255;
  }
  return page;
}

void paste(Image& page, const Image& picture, int x0, int y0) {
  for (int y = 0; y < picture.height_px; ++y) {
    std::copy_n(picture.pixel(0, y), 4 * std::size_t(picture.width_px), page.pixel(x0, y0 + y));
  }
}

void draw_centered(Image& page, const std::string& text, double x, double y,
                   const TextStyle& style) {
  draw_text(page, text, x - 0.5 * text_width_px(text, style), y, style);
}

void fill(Image& page, int x0, int y0, int x1, int y1, const LinearColor& color) {
  for (int y = std::max(0, y0); y < std::min(page.height_px, y1); ++y) {
    for (int x = std::max(0, x0); x < std::min(page.width_px, x1); ++x) {
      std::uint8_t* pixel = page.pixel(x, y);
      pixel[0] = linear_to_srgb8(color.r);
      pixel[1] = linear_to_srgb8(color.g);
      pixel[2] = linear_to_srgb8(color.b);
      pixel[3] = 255;
    }
  }
}

}  // namespace hydrodip
