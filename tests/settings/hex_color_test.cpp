#include "settings/hex_color.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

TEST(HexColor, IsReadAndWrittenWithoutALoss) {
  for (int value = 0; value < 256; ++value) {
    const auto level = std::uint8_t(value);
    const LinearColor color{srgb8_to_linear(level), 0, 1, 1};
    const auto back = parse_color(hex_of(color));
    ASSERT_TRUE(back) << value;
    EXPECT_EQ(back->r, color.r) << value;
    EXPECT_EQ(back->g, 0) << value;
    EXPECT_EQ(back->b, 1) << value;
  }
  EXPECT_EQ(hex_of({1, 0, srgb8_to_linear(0xab), 1}), "#ff00ab");
  EXPECT_EQ(parse_color("#FF00aB")->b, srgb8_to_linear(0xab));
}

TEST(HexColor, OthersAreNone) {
  for (const char* text :
       {"", "#", "ff00ab", "#ff00a", "#ff00abc", "#ff00ag", "#+f00ab", " #ff00ab"})
    EXPECT_FALSE(parse_color(text)) << text;
}

}  // namespace
}  // namespace hydrodip
