#include "transfer/texture_row.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

// A triangle of film over one of the slab's, whose lines lean and fan out.
FilmOnPlane leaning_pair(std::mt19937& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  FilmOnPlane pair;
  pair.object_triangle = int(random() % 2);
  pair.height = {0.3 * part(random), 0.001 * part(random), 0.001 * part(random)};
  pair.slope = {0.9 + 0.1 * part(random), 0.0003 * part(random), 0.0003 * part(random)};
  pair.u = {0.3 + 0.1 * part(random), 0.001 * part(random), 0.001 * part(random)};
  pair.v = {0.3 + 0.1 * part(random), 0.001 * part(random), 0.001 * part(random)};
  pair.u_along = {0.05 * part(random), 0.0001 * part(random), 0.0001 * part(random)};
  pair.v_along = {0.05 * part(random), 0.0001 * part(random), 0.0001 * part(random)};
  return pair;
}

Vec3 mean_of_samples(const Object& object, const FilmOnPlane& pair, int column, int row,
                     int per_axis, const LinearColor& base) {
  Vec3 sum = Vec3::Zero();
  for (int j = 0; j < per_axis; ++j)
    for (int i = 0; i < per_axis; ++i) {
      const LinearColor c = color_at(object, pair.at(column + i, row + j), base);
      sum += Vec3(double(c.r), double(c.g), double(c.b));
    }
  return sum / (per_axis * per_axis);
}

// In parts with nothing but one colour, in others with none like its neighbour.
Object half_painted_slab(std::mt19937& random, Wrap wrap) {
  Object object = fixtures::slab();
  Image texture(61, 47);
  for (std::size_t i = 0; i < texture.rgba.size(); ++i)
    texture.rgba[i] = i % 244 < 120 && i >= texture.rgba.size() / 2
                          ? std::uint8_t(200 - 10 * (i % 4))
                          : std::uint8_t(random());
  fixtures::set_texture(object, std::move(texture));
  object.materials[0].wrap_u = object.materials[0].wrap_v = wrap;
  object.materials[0].base_color = {0.9F, 0.7F, 0.8F, 0.6F};
  std::uniform_real_distribution<float> anywhere(-1.5F, 2.5F);
  object.uvs.clear();
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    CornerUv corners;
    for (auto& corner : corners) corner = {anywhere(random), anywhere(random)};
    object.uvs.push_back(corners);
  }
  return object;
}

TEST(TextureRow, IsTheMeanOfEachPixelsSamples) {
  std::mt19937 random(5);
  const LinearColor base{0.2F, 0.5F, 0.9F, 1};
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp, Wrap::kDecal}) {
    int known = 0;
    for (int n = 0; n < 60; ++n) {
      const Object object = half_painted_slab(random, wrap);
      const FilmOnPlane pair = leaning_pair(random);
      const int per_axis = 1 + n % 4, column = int(random() % 50), row = int(random() % 50);
      std::vector<std::optional<LinearColor>> means(1 + random() % 80);
      TextureRow(object, pair, base).means(column, row, per_axis, means);
      for (std::size_t k = 0; k < means.size(); ++k) {
        if (!means[k]) continue;
        ++known;
        const Vec3 mean =
            mean_of_samples(object, pair, column + int(k) * per_axis, row, per_axis, base);
        EXPECT_NEAR(double(means[k]->r), mean[0], 2e-4);
        EXPECT_NEAR(double(means[k]->g), mean[1], 2e-4);
        EXPECT_NEAR(double(means[k]->b), mean[2], 2e-4);
      }
    }
    EXPECT_GT(known, wrap == Wrap::kRepeat ? 500 : 50);
  }
}

TEST(TextureRow, OfAPlainMaterialIsItsColour) {
  std::mt19937 random(6);
  Object object = fixtures::slab();
  object.materials[0].base_color = {0.25F, 0.5F, 0.75F, 0.5F};
  std::vector<std::optional<LinearColor>> means(40);
  TextureRow(object, leaning_pair(random), {1, 1, 1, 1}).means(3, 4, 3, means);
  for (const auto& mean : means) {
    ASSERT_TRUE(mean);
    EXPECT_NEAR(double(mean->r), 0.625, 1e-6);
    EXPECT_NEAR(double(mean->g), 0.75, 1e-6);
    EXPECT_NEAR(double(mean->b), 0.875, 1e-6);
  }
}

}  // namespace
}  // namespace hydrodip
