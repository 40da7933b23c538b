#include "transfer/texture_mean.h"

#include <gtest/gtest.h>

#include <random>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

Object painted_slab(std::mt19937& random, Wrap wrap, bool translucent) {
  Object object = fixtures::slab();
  Image texture(37, 23);
  for (std::uint8_t& byte : texture.rgba) byte = std::uint8_t(random());
  for (std::size_t i = 3; i < texture.rgba.size() && !translucent; i += 4) texture.rgba[i] = 255;
  fixtures::set_texture(object, std::move(texture));
  object.materials[0].wrap_u = object.materials[0].wrap_v = wrap;
  object.materials[0].base_color = {0.9F, 0.7F, 0.8F, translucent ? 0.6F : 1.0F};
  std::uniform_real_distribution<float> anywhere(-1.5F, 2.5F);
  object.uvs.clear();
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    CornerUv corners;
    for (auto& corner : corners) corner = {anywhere(random), anywhere(random)};
    object.uvs.push_back(corners);
  }
  return object;
}

// A grid of a pixel's samples that is a few texels wide, somewhere in a triangle.
SurfaceGrid some_grid(std::mt19937& random, int per_axis) {
  std::uniform_real_distribution<double> anywhere(0.05, 0.45), step(-0.01, 0.01);
  return {{int(random() % 2), anywhere(random), anywhere(random)},
          step(random),
          step(random),
          step(random),
          step(random),
          per_axis};
}

// Whatever the texture does at its edges, the mean over a grid is that of its points, or of those
// that count, or left to the caller.
TEST(TextureMean, IsTheMeanOfThePoints) {
  std::mt19937 random(11);
  const LinearColor base{0.2F, 0.5F, 0.9F, 1};
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp, Wrap::kDecal})
    for (const bool translucent : {false, true}) {
      int known = 0;
      for (int n = 0; n < 500; ++n) {
        const bool few = n < 400;
        const Object object = painted_slab(random, wrap, translucent);
        SurfaceGrid grid = some_grid(random, few ? 1 + n % 5 : 6 + n % 3);
        if (n % 3 == 0) grid.counted = (std::uint64_t(random()) << 32 | random()) | 1;
        const auto mean = mean_texture_color(object, grid, base);
        if (!mean) continue;
        known += few;
        Vec3 sum = Vec3::Zero();
        int counted = 0;
        for (int k = 0; k < grid.per_axis * grid.per_axis; ++k) {
          if ((grid.counted >> k & 1U) == 0) continue;
          ++counted;
          const LinearColor c =
              color_at(object, grid.at(k % grid.per_axis, k / grid.per_axis), base);
          sum += Vec3(double(c.r), double(c.g), double(c.b));
        }
        EXPECT_EQ(grid.count(), counted);
        sum /= counted;
        EXPECT_NEAR(double(mean->r), sum[0], 2e-4);
        EXPECT_NEAR(double(mean->g), sum[1], 2e-4);
        EXPECT_NEAR(double(mean->b), sum[2], 2e-4);
      }
      EXPECT_GT(known, wrap == Wrap::kRepeat ? 200 : 10);
    }
}

TEST(TextureMean, OfAPlainMaterialIsItsColour) {
  Object object = fixtures::slab();
  object.materials[0].base_color = {0.25F, 0.5F, 0.75F, 0.5F};
  const auto mean = mean_texture_color(object, {{0, 0.2, 0.3}, 0.01, 0, 0, 0.01, 3}, {1, 1, 1, 1});
  ASSERT_TRUE(mean);
  EXPECT_NEAR(double(mean->r), 0.625, 1e-6);
  EXPECT_NEAR(double(mean->g), 0.75, 1e-6);
  EXPECT_NEAR(double(mean->b), 0.875, 1e-6);
}

// Colours at corners multiply a texture: their mean is not the product of means.
TEST(TextureMean, LeavesCornerColoursToTheCaller) {
  Object object = fixtures::slab();
  object.colors.resize(object.triangles.size());
  EXPECT_FALSE(mean_texture_color(object, {{0, 0.2, 0.3}, 0, 0, 0, 0, 3}, {1, 1, 1, 1}));
}

}  // namespace
}  // namespace hydrodip
