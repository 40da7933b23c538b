#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "ink/color_model.h"
#include "ink/discoloration.h"

namespace hydrodip {
namespace {

using Cmyk = std::array<std::uint8_t, 4>;

Cmyk device_cmyk(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a) {
  Image image(1, 1);
  image.rgba = {r, g, b, a};
  const InkImage inks = inks_of_film(image, *make_device_model());
  return {inks.cmyk[0], inks.cmyk[1], inks.cmyk[2], inks.cmyk[3]};
}

TEST(DeviceCmyk, PrimariesNeedTheInksOfTheTextbook) {
  EXPECT_EQ(device_cmyk(255, 255, 255, 255), (Cmyk{0, 0, 0, 0}));
  EXPECT_EQ(device_cmyk(0, 0, 0, 255), (Cmyk{0, 0, 0, 255}));
  EXPECT_EQ(device_cmyk(255, 0, 0, 255), (Cmyk{0, 255, 255, 0}));
  EXPECT_EQ(device_cmyk(0, 255, 0, 255), (Cmyk{255, 0, 255, 0}));
  EXPECT_EQ(device_cmyk(0, 0, 255, 255), (Cmyk{255, 255, 0, 0}));
  EXPECT_EQ(device_cmyk(0, 255, 255, 255), (Cmyk{255, 0, 0, 0}));
  EXPECT_EQ(device_cmyk(255, 0, 255, 255), (Cmyk{0, 255, 0, 0}));
  EXPECT_EQ(device_cmyk(255, 255, 0, 255), (Cmyk{0, 0, 255, 0}));
  EXPECT_EQ(device_cmyk(200, 150, 100, 255), (Cmyk{0, 50, 100, 55}));
}

TEST(DeviceCmyk, GreyIsBlackInkOnly) {
  for (int v = 0; v < 256; ++v) {
    const auto grey = static_cast<std::uint8_t>(v);
    EXPECT_EQ(device_cmyk(grey, grey, grey, 255),
              (Cmyk{0, 0, 0, static_cast<std::uint8_t>(255 - v)}));
  }
}

TEST(DeviceCmyk, OpaqueColoursCanBeRecoveredExactly) {
  for (int r = 0; r < 256; r += 15) {
    for (int g = 0; g < 256; g += 17) {
      for (int b = 0; b < 256; b += 5) {
        const Cmyk ink = device_cmyk(static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g),
                                     static_cast<std::uint8_t>(b), 255);
        EXPECT_EQ(255 - ink[0] - ink[3], r);
        EXPECT_EQ(255 - ink[1] - ink[3], g);
        EXPECT_EQ(255 - ink[2] - ink[3], b);
        EXPECT_EQ(std::min({ink[0], ink[1], ink[2]}), 0) << "full grey replacement";
      }
    }
  }
}

TEST(DeviceCmyk, MorePigmentThanBlackNeedsIsBlack) {
  const auto model = make_device_model();
  const Inks inks{0.5F, 0, 0.25F, 0.75F};
  SrgbColor color;
  model->look(&inks, &color, 1);
  EXPECT_EQ(color.r, 0);
  EXPECT_EQ(color.g, 0.25F);
  EXPECT_EQ(color.b, 0);
}

TEST(DeviceCmyk, TransparentMeansNoInkWhateverTheColour) {
  EXPECT_EQ(device_cmyk(0, 0, 0, 0), (Cmyk{0, 0, 0, 0}));
  EXPECT_EQ(device_cmyk(255, 13, 77, 0), (Cmyk{0, 0, 0, 0}));
}

TEST(DeviceCmyk, CoverageScalesEveryInkAmount) {
  EXPECT_EQ(device_cmyk(0, 0, 0, 128), (Cmyk{0, 0, 0, 128}));
  EXPECT_EQ(device_cmyk(200, 150, 100, 51), (Cmyk{0, 10, 20, 11}));
  for (int a = 0; a < 256; ++a) {
    const Cmyk full = device_cmyk(30, 90, 220, 255);
    const Cmyk part = device_cmyk(30, 90, 220, static_cast<std::uint8_t>(a));
    for (int i = 0; i < 4; ++i) {
      EXPECT_LE(std::abs(2 * (255 * part[i] - full[i] * a)), 255) << "not the nearest byte";
    }
  }
}

}  // namespace
}  // namespace hydrodip
