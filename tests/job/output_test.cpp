#include "job/output.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace hydrodip {
namespace {

// All ways to share what one ink may be among four: each is exactly at the limit.
TEST(InkAmounts, OfASheetAtTheLimitAreNotOverIt) {
  for (int c = 0; c <= 255; ++c)
    for (int m = 0; m <= 255 - c; m += 3) {
      InkImage sheet(1, 1);
      const int y = (255 - c - m) / 2;
      const int inks[] = {c, m, y, 255 - c - m - y};
      for (int k = 0; k < 4; ++k) sheet.cmyk[std::size_t(k)] = std::uint8_t(inks[k]);
      ASSERT_EQ(ink_amounts(sheet, 1).density_max, 1) << c << ", " << m;
    }
}

TEST(InkAmounts, AreTheHeaviestPixelAndTheMeanOfEachInk) {
  InkImage sheet(2, 1);
  sheet.cmyk = {255, 0, 51, 0, 51, 51, 51, 51};
  const ReportInk amounts = ink_amounts(sheet, 2.5);
  EXPECT_DOUBLE_EQ(amounts.density_max, 1.2);
  EXPECT_EQ(amounts.density_limit, 2.5);
  EXPECT_DOUBLE_EQ(amounts.mean[0], 0.6);
  EXPECT_DOUBLE_EQ(amounts.mean[1], 0.1);
  EXPECT_DOUBLE_EQ(amounts.mean[2], 0.2);
  EXPECT_DOUBLE_EQ(amounts.mean[3], 0.1);
}

}  // namespace
}  // namespace hydrodip
