// Files that are dropped together, by their names.
#include "studio/adoption.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

// What was told of each file.
Json uses(const Adoption& adoption) {
  Json uses = Json::object();
  for (const Json& file : adoption.told()) uses[file["file"]] = file["as"];
  return uses;
}

TEST(Adoption, AModelTakesThePlaceOfTheOldOneAndPicturesBecomeLayers) {
  const Adoption adoption({"logo.svg", "toy.stl", "skin.png"});
  Json document = {{"object", {{"file", "old.obj"}, {"texture", "old.png"}}}};
  adoption.put_into(document);
  EXPECT_EQ(document["object"], Json({{"file", "toy.stl"}}));
  EXPECT_EQ(document["artwork"], Json::array({{{"image", "logo.svg"}}, {{"image", "skin.png"}}}));
  EXPECT_EQ(adoption.told()[0]["file"], "toy.stl");  // first, as it is what the rest is about
  EXPECT_EQ(uses(adoption),
            Json({{"toy.stl", "model"}, {"logo.svg", "layer"}, {"skin.png", "layer"}}));
}

TEST(Adoption, WhatTheModelNamesIsNoLayer) {
  Adoption adoption({"toy.obj", "toy.mtl", "toy.png", "skin.png"});
  adoption.add_part("toy.mtl");
  adoption.add_part("toy.png");
  adoption.set_texture("skin.png");
  Json document = Json::object();
  adoption.put_into(document);
  EXPECT_EQ(document, Json({{"object", {{"file", "toy.obj"}, {"texture", "skin.png"}}}}));
  EXPECT_EQ(
      uses(adoption),
      Json({{"toy.obj", "model"}, {"toy.mtl", "part"}, {"toy.png", "part"}, {"skin.png", "part"}}));
}

TEST(Adoption, PicturesAloneLeaveTheModelAsItIs) {
  const Adoption adoption({"logo.png"});
  EXPECT_EQ(adoption.model(), "");
  Json document = {{"object", {{"file", "toy.obj"}, {"texture", "skin.png"}}}};
  adoption.put_into(document);
  EXPECT_EQ(document["object"], Json({{"file", "toy.obj"}, {"texture", "skin.png"}}));
  EXPECT_EQ(document["artwork"].size(), 1u);
}

// All that comes with a job file is what it names.
TEST(Adoption, OfAJobEverythingIsAPart) {
  const Adoption adoption({"toy.obj", "logo.png", "toy.toml"});
  EXPECT_EQ(adoption.job(), "toy.toml");
  EXPECT_EQ(adoption.model(), "");
  Json document = Json::object();
  adoption.put_into(document);
  EXPECT_EQ(document, Json::object());
  EXPECT_EQ(uses(adoption), Json({{"toy.toml", "job"}, {"logo.png", "part"}}));
}

TEST(Adoption, ASecondModelIsOfNoUse) {
  const Adoption adoption({"one.stl", "two.stl"});
  EXPECT_EQ(adoption.model(), "one.stl");
  EXPECT_EQ(uses(adoption), Json({{"one.stl", "model"}, {"two.stl", "unused"}}));
  for (const Json& file : adoption.told())  // and why is said
    EXPECT_EQ(file["text"].get<std::string>().empty(), file["as"] == "model") << file;
}

}  // namespace
}  // namespace hydrodip
