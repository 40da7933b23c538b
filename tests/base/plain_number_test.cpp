#include "base/plain_number.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

TEST(PlainNumber, SharesSayAsMuchAsCounts) {
  EXPECT_EQ(percent(0), "0 %");
  EXPECT_EQ(percent(0.0004), "under 0.1 %");
  EXPECT_EQ(percent(0.089), "8.9 %");
  EXPECT_EQ(percent(0.0996), "10 %");
  EXPECT_EQ(percent(0.694), "69 %");
}

TEST(PlainNumber, HasNoExponent) {
  EXPECT_EQ(plain_number(0), "0");
  EXPECT_EQ(plain_number(2e-5), "under 0.01");
  EXPECT_EQ(plain_number(0.241), "0.24");
  EXPECT_EQ(plain_number(0.996), "1.0");
  EXPECT_EQ(plain_number(2.41), "2.4");
  EXPECT_EQ(plain_number(284), "284");
  EXPECT_EQ(three_digits(0), "0");
  EXPECT_EQ(three_digits(-2e-7), "0");
  EXPECT_EQ(three_digits(0.65), "0.65");
  EXPECT_EQ(three_digits(-0.02345), "-0.0234");
  EXPECT_EQ(three_digits(1004), "1000");
  EXPECT_EQ(three_digits(126480), "126000");
}

TEST(PlainNumber, IsRoundedToDigits) {
  EXPECT_EQ(rounded_to_digits(0.650349, 4), 0.6503);
  EXPECT_EQ(rounded_to_digits(126480, 3), 126000);
  EXPECT_EQ(rounded_to_digits(-1e-9, 2), -1e-9);
  EXPECT_TRUE(std::isnan(rounded_to_digits(std::nan(""), 3)));
}

}  // namespace
}  // namespace hydrodip
