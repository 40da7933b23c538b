// A page that pictures, legends and labels are put on.
#pragma once

#include <string>

#include "image/image.h"
#include "render/text.h"

namespace hydrodip {

constexpr LinearColor kTitleInk{0.012f, 0.014f, 0.02f, 1};
constexpr LinearColor kLabelInk{0.06f, 0.065f, 0.08f, 1};

constexpr int kWidestPicture_px = 16384;

// Nearly white, opaque.
Image blank_page(int width_px, int height_px);

// Copies a picture that lies wholly on the page.
void paste(Image& page, const Image& picture, int x0, int y0);

// One line, centred at x, with its baseline at y.
void draw_centered(Image& page, const std::string& text, double x, double y,
                   const TextStyle& style);

// Fills the pixels [x0, x1) x [y0, y1), as far as they are on the page.
void fill(Image& page, int x0, int y0, int x1, int y1, const LinearColor& color);

}  // namespace hydrodip
