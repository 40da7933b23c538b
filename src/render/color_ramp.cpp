#include "render/color_ramp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math.h"

namespace hydrodip {
namespace {

Vec3 to_oklab(const Tone& tone) {
  const double hue = tone.hue_deg * std::numbers::pi / 180;
  return {tone.lightness, tone.chroma * std::cos(hue), tone.chroma * std::sin(hue)};
}

// Bjorn Ottosson, "A perceptual color space for image processing", 2020: the inverse matrices.
LinearColor to_linear(const Vec3& lab) {
  const auto cubed = [&](double a, double b) {
    const double root = lab[0] + a * lab[1] + b * lab[2];
    return root * root * root;
  };
  const double l = cubed(0.3963377774, 0.2158037573);
  const double m = cubed(-0.1055613458, -0.0638541728);
  const double s = cubed(-0.0894841775, -1.2914855480);
  const auto channel = [](double value) { return float(std::clamp(value, 0.0, 1.0)); };
  return {channel(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          channel(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          channel(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 1};
}

// The parabola through three tones, at 0, 1/2 and 1.
Tone tone_at(const Tone& a, const Tone& b, const Tone& c, double t) {
  const double wa = (1 - t) * (1 - 2 * t), wb = 4 * t * (1 - t), wc = t * (2 * t - 1);
  return {wa * a.lightness + wb * b.lightness + wc * c.lightness,
          wa * a.chroma + wb * b.chroma + wc * c.chroma,
          wa * a.hue_deg + wb * b.hue_deg + wc * c.hue_deg};
}

}  // namespace

ColorRamp::ColorRamp(const Tone& begin, const Tone& middle, const Tone& end) {
  // Length along the path, so that equal steps in t are equal distances between colours.
  constexpr std::size_t kSteps = 4096;
  std::array<double, kSteps + 1> length{};
  Vec3 last = to_oklab(begin);
  for (std::size_t i = 1; i <= kSteps; ++i) {
    const Vec3 next = to_oklab(tone_at(begin, middle, end, double(i) / kSteps));
    length[i] = length[i - 1] + (next - last).norm();
    last = next;
  }
  std::size_t step = 0;
  for (std::size_t i = 0; i < kEntries; ++i) {
    const double wanted = length[kSteps] * double(i) / (kEntries - 1);
    while (step + 1 < kSteps && length[step + 1] < wanted) ++step;
    const double within = length[step + 1] - length[step];
    const double t = double(step) + (within > 0 ? (wanted - length[step]) / within : 0);
    table_[i] = to_linear(to_oklab(tone_at(begin, middle, end, t / kSteps)));
  }
}

LinearColor ColorRamp::at(double t) const {
  const double x = std::clamp(t, 0.0, 1.0) * (kEntries - 1);
  const std::size_t i = std::min(kEntries - 2, std::size_t(x));
  const float f = float(x - double(i));
  const LinearColor &a = table_[i], &b = table_[i + 1];
  return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b), 1};
}

}  // namespace hydrodip
