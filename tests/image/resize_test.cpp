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
