#include "image/pixel_set.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

// Rows end in the middle of a word.
TEST(PixelSet, HoldsWhatIsPutIn) {
  constexpr int kWidth = 131, kHeight = 5;
  PixelSet set(kWidth, kHeight);
  const auto chosen = [](int x, int y) { return (7 * x + 3 * y) % 5 == 0 || x % 64 == 63; };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (chosen(x, y)) set.insert(x, y);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) EXPECT_EQ(set.contains(x, y), chosen(x, y)) << x << ", " << y;
}

}  // namespace
}  // namespace hydrodip
