#include "base/plain_number.h"

#include <gtest/gtest.h>

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
}

}  // namespace
}  // namespace hydrodip
