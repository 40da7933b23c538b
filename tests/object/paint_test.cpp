#include "object/paint.h"

#include <gtest/gtest.h>

#include <array>

#include "object/bake.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr LinearColor kGrey{0.2F, 0.3F, 0.4F, 1};

std::array<float, 3> rgb(const LinearColor& c) { return {c.r, c.g, c.b}; }

std::shared_ptr<const Object> plain_sphere() {
  auto object = std::make_shared<Object>(make_sample("sphere"));
  object->textures.clear();
  object->colors.clear();
  object->uvs.clear();
  object->materials.assign(1, Material{});
  object->material_of.assign(object->triangles.size(), 0);
  return object;
}

// Nobody asks for white who dips a grey thing whose model says nothing of colours.
TEST(ModelPaint, AModelThatSaysNothingIsWantedBare) {
  const auto object = plain_sphere();
  const auto paint = model_paint(object, kGrey);
  EXPECT_FALSE(paint->says_anything());
  EXPECT_EQ(rgb(paint->color_at({0, 0.3, 0.3})), rgb(kGrey));
  EXPECT_EQ(rgb(model_paint(object)->color_at({0, 0.3, 0.3})), (std::array<float, 3>{1, 1, 1}));
  const Object shown = painted_object(*object, *paint, {512});
  const LinearColor seen = color_at(shown, {0, 0.3, 0.3}, {1, 1, 1, 1});
  EXPECT_NEAR(seen.r, kGrey.r, 0.01F);
  EXPECT_NEAR(seen.b, kGrey.b, 0.01F);
}

// The grey of an MTL that states no colour was printed where a pixel showed one triangle, and white
// where it showed two.
TEST(ModelPaint, AFormatsDefaultColourIsNowhereWanted) {
  auto object = std::make_shared<Object>(*plain_sphere());
  object->materials[0].base_color = {0.3F, 0.3F, 0.3F, 1};
  object->materials[0].color_is_default = true;
  const auto paint = model_paint(object);
  EXPECT_FALSE(paint->says_anything());
  EXPECT_EQ(rgb(paint->color_at({0, 0.3, 0.3})), (std::array<float, 3>{1, 1, 1}));
  EXPECT_EQ(paint->as_object(), nullptr);
  object->materials[0].color_is_default = false;
  EXPECT_TRUE(model_paint(object)->says_anything());
}

TEST(ModelPaint, WhatAModelStatesIsWantedOnAnyObject) {
  auto object = std::make_shared<Object>(*plain_sphere());
  object->materials[0].base_color = {0.9F, 0.1F, 0.1F, 1};
  const auto paint = model_paint(object, kGrey);
  EXPECT_TRUE(paint->says_anything());
  EXPECT_EQ(rgb(paint->color_at({0, 0.3, 0.3})), (std::array<float, 3>{0.9F, 0.1F, 0.1F}));
}

}  // namespace
}  // namespace hydrodip
