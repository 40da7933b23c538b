#include "image/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hydrodip {
namespace {

TEST(Srgb, KnownValues) {
  EXPECT_EQ(srgb_to_linear(0), 0);
  EXPECT_FLOAT_EQ(srgb_to_linear(1), 1);
  EXPECT_NEAR(srgb_to_linear(0.5f), 0.21404114f, 1e-7);
  EXPECT_NEAR(linear_to_srgb(0.18f), 0.46135613f, 1e-6);
  EXPECT_NEAR(srgb8_to_linear(188), 0.50288647f, 1e-6);
}

TEST(Srgb, EveryByteSurvivesTheRoundTrip) {
  for (int byte = 0; byte < 256; ++byte) {
    EXPECT_EQ(linear_to_srgb8(srgb8_to_linear(std::uint8_t(byte))), byte);
  }
}

TEST(Srgb, RoundsToTheNearestByteEverywhere) {
  for (int i = 0; i <= 100000; ++i) {
    const float linear = float(i) / 100000;
    const double exact = 255 * double(linear_to_srgb(linear));
    EXPECT_LE(std::abs(exact - linear_to_srgb8(linear)), 0.5 + 1e-4) << linear;
  }
}

TEST(Srgb, ClampsWhatLiesOutside) {
  EXPECT_EQ(linear_to_srgb8(-1), 0);
  EXPECT_EQ(linear_to_srgb8(2), 255);
  EXPECT_EQ(linear_to_srgb8(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(linear_to_srgb8(std::numeric_limits<float>::infinity()), 255);
}

}  // namespace
}  // namespace hydrodip
