// Text on pictures, drawn with a small stroke font of our own: nothing to find or load at run time.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace hydrodip {

struct TextStyle {
  double size_px = 24;    // height of a capital letter
  double weight = 0.115;  // stroke width over capital height
  LinearColor color{0, 0, 0, 1};
};

// Of the usual weight.
inline TextStyle text_style(double size_px, const LinearColor& color) {
  TextStyle style;
  style.size_px = size_px;
  style.color = color;
  return style;
}

// Width of a line of text in pixels. Text is UTF-8; characters without a glyph show as a box.
double text_width_px(const std::string& text, const TextStyle& style);

// Draws one line, antialiased and blended in linear light over an opaque picture; (x, y) is the
// start of the baseline. Whatever falls outside the picture is left out.
void draw_text(Image& image, const std::string& text, double x_px, double y_px,
               const TextStyle& style);

// The text cut at its end, with three dots, so that it is no wider than max_width.
std::string fit_text(const std::string& text, const TextStyle& style, double max_width_px);

// The text in lines of whole words no wider than that, at most so many; the last is cut.
std::vector<std::string> fit_lines(const std::string& text, const TextStyle& style,
                                   double max_width_px, std::size_t most);

}  // namespace hydrodip
