#include "object/object.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hydrodip {
namespace {

// One triangle whose UVs equal its plane coordinates.
Object triangle_with(Image image, Wrap wrap_u = Wrap::kRepeat, Wrap wrap_v = Wrap::kRepeat) {
  Object object;
  object.positions = {{-8, -8, 0}, {24, -8, 0}, {-8, 24, 0}};
  object.triangles = {{0, 1, 2}};
  object.material_of = {0};
  object.uvs = {{Eigen::Vector2f(-8, -8), Eigen::Vector2f(24, -8), Eigen::Vector2f(-8, 24)}};
  Material material;
  material.texture = 0;
  material.wrap_u = wrap_u;
  material.wrap_v = wrap_v;
  object.materials = {material};
  object.textures = {std::make_shared<const Image>(std::move(image))};
  return object;
}

SurfacePoint at(double u, double v) { return {0, (u + 8) / 32, (v + 8) / 32}; }

Image picture(int width, int height, std::initializer_list<std::array<int, 4>> pixels) {
  Image image(width, height);
  std::size_t i = 0;
  for (const auto& pixel : pixels) {
    for (const int channel : pixel) image.rgba[i++] = std::uint8_t(channel);
  }
  return image;
}

constexpr std::array<int, 4> kRed = {255, 0, 0, 255}, kGreen = {0, 255, 0, 255},
                             kBlue = {0, 0, 255, 255}, kBlackPixel = {0, 0, 0, 255};
constexpr LinearColor kBase{0.25f, 0.5f, 0.75f, 1};

void expect_opaque(const LinearColor& color, double r, double g, double b) {
  EXPECT_NEAR(color.r, r, 1e-5);
  EXPECT_NEAR(color.g, g, 1e-5);
  EXPECT_NEAR(color.b, b, 1e-5);
  EXPECT_EQ(color.a, 1);
}

TEST(ColorAt, BottomRowIsAtVZero) {
  const Object object = triangle_with(picture(1, 2, {kRed, kGreen}));
  expect_opaque(color_at(object, at(0.5, 0.25), kBase), 0, 1, 0);
  expect_opaque(color_at(object, at(0.5, 0.75), kBase), 1, 0, 0);
}

// Numbers that exporters write where they have none: sums of them are no numbers any more.
TEST(ColorAt, CoordinatesOutOfAllBoundsAreSomeTexel) {
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp, Wrap::kDecal}) {
    Object object = triangle_with(picture(2, 2, {kRed, kRed, kRed, kRed}), wrap, wrap);
    for (const float far : {kMost, -kMost, 1e31F, -1e31F, 1e20F})
      for (const double u : {0.2, 0.3, 1.0 / 3}) {
        const Eigen::Vector2f corner(far, far);
        object.uvs = {{corner, corner, corner}};
        const LinearColor color = color_at(object, {0, u, 0.3}, kBase);
        EXPECT_TRUE(std::isfinite(color.r + color.g + color.b)) << far;
      }
  }
}

TEST(ColorAt, InterpolatesInLinearLight) {
  const Object object = triangle_with(picture(2, 1, {kRed, kBlackPixel}), Wrap::kClamp);
  for (const double t : {0.0, 0.2, 0.5, 0.9}) {
    expect_opaque(color_at(object, at(0.25 + 0.5 * t, 0.5), kBase), 1 - t, 0, 0);
  }
}

TEST(ColorAt, WrapModes) {
  const Image three = picture(3, 1, {kRed, kGreen, kBlue});
  const double red = 0.5 / 3, green = 0.5, blue = 2.5 / 3;
  const Object repeat = triangle_with(three);
  const Object mirror = triangle_with(three, Wrap::kMirror);
  const Object clamp = triangle_with(three, Wrap::kClamp);
  for (const int period : {-3, -2, -1, 0, 1, 2}) {
    expect_opaque(color_at(repeat, at(period + red, 0.5), kBase), 1, 0, 0);
    expect_opaque(color_at(repeat, at(period + green, 0.5), kBase), 0, 1, 0);
    const bool turned = period % 2 != 0;
    expect_opaque(color_at(mirror, at(period + red, 0.5), kBase), !turned, 0, turned);
    expect_opaque(color_at(mirror, at(period + green, 0.5), kBase), 0, 1, 0);
    if (period != 0) {
      expect_opaque(color_at(clamp, at(period + green, 0.5), kBase), period<0, 0, period> 0);
    }
  }
  // Repeating blends the right edge into the left one; the others do not.
  expect_opaque(color_at(repeat, at(1, 0.5), kBase), 0.5, 0, 0.5);
  expect_opaque(color_at(mirror, at(1, 0.5), kBase), 0, 0, 1);
  expect_opaque(color_at(clamp, at(blue + 0.1, 0.5), kBase), 0, 0, 1);
}

TEST(ColorAt, DecalShowsTheBaseColourOutside) {
  Object object = triangle_with(picture(1, 1, {kRed}), Wrap::kDecal, Wrap::kDecal);
  object.materials[0].base_color = {1, 0.5f, 0.25f, 1};
  expect_opaque(color_at(object, at(0.5, 0.5), kBase), 1, 0, 0);
  expect_opaque(color_at(object, at(1.5, 0.5), kBase), 1, 0.5, 0.25);
  expect_opaque(color_at(object, at(0.5, -0.1), kBase), 1, 0.5, 0.25);
}

TEST(ColorAt, AlphaLetsTheBareObjectShow) {
  Object object = triangle_with(picture(1, 1, {{255, 255, 255, 51}}));
  object.materials[0].base_color = {1, 1, 1, 0.5f};
  expect_opaque(color_at(object, at(0.5, 0.5), kBase), 0.1 + 0.9 * 0.25, 0.1 + 0.9 * 0.5,
                0.1 + 0.9 * 0.75);
}

TEST(ColorAt, HiddenColoursOfTransparentTexelsDoNotBleed) {
  const Object object =
      triangle_with(picture(2, 1, {{255, 0, 0, 255}, {0, 255, 0, 0}}), Wrap::kClamp);
  expect_opaque(color_at(object, at(0.5, 0.5), {0, 0, 0, 1}), 0.5, 0, 0);
}

TEST(ColorAt, VertexColoursBlendLinearlyAndMultiply) {
  Object object = triangle_with(picture(1, 1, {{255, 255, 255, 255}}));
  object.colors = {{LinearColor{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}};
  object.materials[0].base_color = {0.5f, 1, 1, 1};
  const LinearColor color = color_at(object, {0, 0.2, 0.3}, kBase);
  expect_opaque(color, 0.25, 0.2, 0.3);
}

TEST(ColorAt, HugeCoordinatesStayInThePicture) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp, Wrap::kDecal}) {
    Object object = triangle_with(picture(2, 2, {kRed, kRed, kRed, kRed}), wrap, wrap);
    object.materials[0].base_color = {1, 0, 0, 1};
    object.uvs = {{Eigen::Vector2f(-3e38f, 3e38f), Eigen::Vector2f(3e38f, 1e20f),
                   Eigen::Vector2f(1e9f, -1e-30f)}};
    for (const double u : {0.0, 0.3, 0.5, 1.0}) {
      expect_opaque(color_at(object, {0, u, 0}, kBase), 1, 0, 0);
    }
  }
}

// Whoever asks for a point that is none gets a colour of the picture, not a crash.
TEST(ColorAt, WhatIsNoNumberStaysInThePicture) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp, Wrap::kDecal}) {
    Object object = triangle_with(picture(2, 2, {kRed, kRed, kRed, kRed}), wrap, wrap);
    object.materials[0].base_color = {1, 0, 0, 1};
    for (const double u : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -1e300})
      expect_opaque(color_at(object, {0, u, 0.5}, kBase), 1, 0, 0);
  }
}

TEST(Object, AppearanceNeedsMoreThanOnePlainColour) {
  Object object = triangle_with(picture(1, 1, {kRed}));
  EXPECT_TRUE(object.has_appearance());
  object.uvs.clear();
  EXPECT_FALSE(object.has_appearance());
  object.colors.resize(1);
  EXPECT_TRUE(object.has_appearance());
  object.colors.clear();
  object.triangles.push_back({0, 2, 1});
  object.material_of.push_back(1);
  object.materials.push_back(Material());
  EXPECT_FALSE(object.has_appearance());
  object.materials[1].base_color = {1, 0, 0, 1};
  EXPECT_TRUE(object.has_appearance());
}

TEST(Object, PositionsAndNormals) {
  const Object object = triangle_with(picture(1, 1, {kRed}));
  EXPECT_NEAR((position_at(object, at(3, 5)) - Vec3(3, 5, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(face_normal(object, 0), Vec3(0, 0, 1));
}

}  // namespace
}  // namespace hydrodip
