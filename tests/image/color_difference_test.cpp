#include "image/color_difference.h"

#include <gtest/gtest.h>

#include <array>

namespace hydrodip {
namespace {

// Pairs of the formula's published test data (Sharma, Wu and Dalal 2005, table 1): they exercise
// each of its discontinuities.
TEST(ColorDifference, AgreesWithThePublishedPairs) {
  struct Pair {
    Vec3 a, b;
    double difference;
  };
  const std::array<Pair, 12> pairs = {{
      {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
      {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
      {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
      {{50, 0, 0}, {50, -1, 2}, 2.3669},
      {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
      {{50, 2.49, -0.001}, {50, -2.49, 0.0011}, 7.2195},
      {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
      {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
      {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
      {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
      {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
      {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
  }};
  for (const Pair& pair : pairs) {
    EXPECT_NEAR(ciede2000(pair.a, pair.b), pair.difference, 6e-5);
    EXPECT_NEAR(ciede2000(pair.b, pair.a), pair.difference, 6e-5);
  }
}

TEST(ColorDifference, WhiteBlackAndGrey) {
  const Vec3 white = to_cielab({1, 1, 1, 1});
  EXPECT_NEAR((white - Vec3(100, 0, 0)).norm(), 0, 0.02);
  EXPECT_NEAR(to_cielab({0, 0, 0, 1}).norm(), 0, 1e-12);
  const float grey = srgb_to_linear(0.5f);
  EXPECT_NEAR(to_cielab({grey, grey, grey, 1})[0], 53.39, 0.01);
  EXPECT_EQ(ciede2000(white, white), 0);
}

}  // namespace
}  // namespace hydrodip
