// Means of colours that cover parts of a pixel.
#pragma once

#include "image/image.h"

namespace hydrodip {

// Averages colours by their coverage, in linear light.
struct ColorSum {
  float r = 0, g = 0, b = 0, a = 0;
  void add(const LinearColor& c, float weight) {
    r += weight * c.a * c.r;
    g += weight * c.a * c.g;
    b += weight * c.a * c.b;
    a += weight * c.a;
  }
  LinearColor color() const {
    if (!(a > 0)) return {0, 0, 0, 0};
    return {r / a, g / a, b / a, a};
  }
};

}  // namespace hydrodip
