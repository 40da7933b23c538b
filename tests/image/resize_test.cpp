#include "image/resize.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

void set(Image& image, int x, int y, std::uint8_t r, std::uint8_t g, std::uint8_t b,
         std::uint8_t a) {
  std::uint8_t* p = image.pixel(x, y);
  p[0] = r, p[1] = g, p[2] = b, p[3] = a;
}

TEST(Resize, TheSameSizeIsTheSameImage) {
  Image image(3, 2);
  for (int i = 0; i < 6; ++i) set(image, i % 3, i / 3, std::uint8_t(40 * i), 7, 200, 255);
  EXPECT_EQ(resize(image, 3, 2).rgba, image.rgba);
}

TEST(Resize, AveragesInLinearLight) {
  Image image(2, 1);
  set(image, 0, 0, 0, 0, 0, 255);
  set(image, 1, 0, 255, 255, 255, 255);
  const Image one = resize(image, 1, 1);
  EXPECT_EQ(one.pixel(0, 0)[0], linear_to_srgb8(0.5f));  // 188, not 128
  EXPECT_EQ(one.pixel(0, 0)[3], 255);
}

TEST(Resize, TransparentPixelsHaveNoColor) {
  Image image(2, 1);
  set(image, 0, 0, 200, 100, 50, 255);
  set(image, 1, 0, 0, 255, 0, 0);
  const Image one = resize(image, 1, 1);
  EXPECT_EQ(one.pixel(0, 0)[0], 200);
  EXPECT_EQ(one.pixel(0, 0)[1], 100);
  EXPECT_EQ(one.pixel(0, 0)[2], 50);
  EXPECT_EQ(one.pixel(0, 0)[3], 128);
}

// Four times as much of the blue one as of the red one, and half of the area is covered.
TEST(Resize, ColoursCountByWhatTheyCover) {
  Image image(2, 1);
  set(image, 0, 0, 255, 0, 0, 51);
  set(image, 1, 0, 0, 0, 255, 204);
  const Image one = resize(image, 1, 1);
  EXPECT_EQ(one.pixel(0, 0)[0], linear_to_srgb8(0.2f));
  EXPECT_EQ(one.pixel(0, 0)[2], linear_to_srgb8(0.8f));
  EXPECT_NEAR(one.pixel(0, 0)[3], 127.5, 0.5);
}

// Of three pixels to two, each gets one and a half.
TEST(Resize, PartsOfAPixelCountByTheirSize) {
  Image wide(3, 1), high(1, 3);
  for (int i = 0; i < 3; ++i) {
    const auto white = std::uint8_t(i == 0 ? 255 : 0);
    set(wide, i, 0, white, white, white, 255);
    set(high, 0, i, white, white, white, 255);
  }
  const Image across = resize(wide, 2, 1), down = resize(high, 1, 2);
  EXPECT_EQ(across.pixel(0, 0)[0], linear_to_srgb8(2 / 3.0f));
  EXPECT_EQ(across.pixel(1, 0)[0], 0);
  EXPECT_EQ(down.rgba, across.rgba);
}

// Whichever row of those that are averaged it is in.
TEST(Resize, NothingThatShowsIsLeftOut) {
  for (int shown = 0; shown < 4; ++shown) {
    Image image(24, 4);
    for (int y = 0; y < 4; ++y) set(image, 6 * y, y, 90, 90, 90, 255);
    const Image row = resize(image, 24, 1);
    const std::uint8_t* p = row.pixel(6 * shown, 0);
    EXPECT_EQ(p[0], 90) << shown;
    EXPECT_EQ(p[3], 64) << shown;
  }
}

TEST(Resize, AConstantStaysConstantAtAnySize) {
  Image image(7, 5);
  for (int i = 0; i < 35; ++i) set(image, i % 7, i / 7, 12, 99, 240, 255);
  for (const auto& [w, h] : {std::pair(3, 2), std::pair(13, 11), std::pair(1, 1)}) {
    const Image other = resize(image, w, h);
    for (int i = 0; i < w * h; ++i) {
      const std::uint8_t* p = other.pixel(i % w, i / w);
      EXPECT_EQ(p[0], 12);
      EXPECT_EQ(p[1], 99);
      EXPECT_EQ(p[2], 240);
      EXPECT_EQ(p[3], 255);
    }
  }
}

TEST(ShrinkTo, KeepsTheShape) {
  const Image image(400, 200);
  EXPECT_EQ(shrink_to(image, 1000).width_px, 400);
  EXPECT_EQ(shrink_to(image, 100).width_px, 100);
  EXPECT_EQ(shrink_to(image, 100).height_px, 50);
  EXPECT_EQ(shrink_to(Image(1000, 1), 100).height_px, 1);
}

}  // namespace
}  // namespace hydrodip
