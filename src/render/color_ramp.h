// Colour scales for maps: even steps of what is shown are even steps for the eye, and lightness
// alone already tells them apart, so that they work for colour-blind readers and in greyscale.
#pragma once

#include <array>

#include "image/image.h"

namespace hydrodip {

// A place in OKLab (Ottosson 2020) in polar form.
struct Tone {
  double lightness = 0.5;  // 0 black, 1 white
  double chroma = 0;
  double hue_deg = 0;
};

class ColorRamp {
 public:
  // From one tone over another to a third; hues are interpolated as given, not the short way round.
  ColorRamp(const Tone& begin, const Tone& middle, const Tone& end);

  // Linear light, opaque; t in [0, 1], clamped.
  LinearColor at(double t) const;

 private:
  static constexpr std::size_t kEntries = 257;
  std::array<LinearColor, kEntries> table_;
};

}  // namespace hydrodip
