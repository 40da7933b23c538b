#include "render/color_ramp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math.h"
#include "render/maps.h"

namespace hydrodip {
namespace {

// OKLab of a colour, by the published forward matrices (the ramp uses the inverse ones).
Vec3 oklab(const LinearColor& c) {
  const double r = double(c.r), g = double(c.g), b = double(c.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

// The scales of the maps, as `count` colours each.
std::vector<std::vector<LinearColor>> scales(int count) {
  std::vector<std::vector<LinearColor>> all(3);
  for (int i = 0; i <= count; ++i) {
    const double t = double(i) / count;
    all[0].push_back(angle_color(kDipAngleLimit_deg * t));
    all[1].push_back(angle_color(45.2 + (89.8 - 45.2) * t));
    all[2].push_back(stretch_color(1 + 0.4 * t, 1.4));
  }
  return all;
}

TEST(ColorRamp, EndsWhereItWasToldTo) {
  const ColorRamp ramp({0.3, 0.05, 280}, {0.6, 0.05, 190}, {0.9, 0.05, 100});
  EXPECT_NEAR(oklab(ramp.at(0))[0], 0.3, 1e-4);
  EXPECT_NEAR(oklab(ramp.at(1))[0], 0.9, 1e-4);
  EXPECT_EQ(ramp.at(-1).r, ramp.at(0).r);
  EXPECT_EQ(ramp.at(2).r, ramp.at(1).r);
}

// Clipping to what a screen can show would bend the scale: equal steps then fail.
TEST(ColorRamp, EqualStepsLookEqual) {
  for (const auto& scale : scales(20)) {
    double least = 1e300, most = 0;
    for (std::size_t i = 0; i + 1 < scale.size(); ++i) {
      const double step = (oklab(scale[i + 1]) - oklab(scale[i])).norm();
      least = std::min(least, step);
      most = std::max(most, step);
    }
    EXPECT_LT(most, 1.1 * least);
  }
}

TEST(ColorRamp, LightnessAloneTellsValuesApart) {
  for (const auto& scale : scales(50)) {
    const bool rises = oklab(scale.back())[0] > oklab(scale.front())[0];
    for (std::size_t i = 0; i + 1 < scale.size(); ++i) {
      EXPECT_EQ(oklab(scale[i + 1])[0] > oklab(scale[i])[0], rises);
    }
  }
}

TEST(ColorRamp, TheLimitIsABreakInHueAndInLightness) {
  const Vec3 at = oklab(angle_color(45)), beyond = oklab(angle_color(45.2));
  EXPECT_GT(at[0] - beyond[0], 0.12);  // visible in greyscale
  EXPECT_LT(at[2], 0.0);               // blue side
  EXPECT_GT(beyond[2], 0.08);          // yellow side: apart for red-green blind eyes too
  EXPECT_GT((at - beyond).norm(), 0.2);
}

}  // namespace
}  // namespace hydrodip
