// Layers of artwork as files and options say them.
#include "settings/artwork_tables.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "contains.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

class ArtworkTables : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("artwork_tables_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  JobConfig configured(const std::string& toml, const std::vector<Setting>& options = {}) {
    std::ofstream(folder_ / "job.toml", std::ios::binary) << toml;
    SettingSources sources;
    sources.configs = {folder_ / "job.toml"};
    sources.options = options;
    JobConfig config;
    apply_sources(config, sources);
    return config;
  }
  std::string error(const std::string& toml, const std::vector<Setting>& options = {}) {
    try {
      configured(toml, options);
    } catch (const InputError& refused) {
      return refused.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

Setting option(const std::string& key, const std::string& value) {
  return {"art." + key, value, false, "'" + value + "'", "--art-" + key};
}

TEST_F(ArtworkTables, LayersComeBottomFirstWithFilesBesideTheJob) {
  const JobConfig config = configured(
      "[film]\nwidth_mm = 200\n[[artwork]]\nimage = 'wood.png'\nprojection = 'box'\n"
      "repeat = 'tile'\nsize_mm = 40\n\n[[artwork]]\ntext = 'No. 7'\nat_mm = [1, -2, 3.5]\n"
      "toward = [0, 0, -1]\nup = [0, 1, 0]\nsize_mm = [30, 8]\nturn_deg = -15\nthrough = true\n"
      "fade_deg = 60\nopacity = 0.5\nblend = 'multiply'\ntext_color = '#ff0000'\n");
  EXPECT_EQ(config.design.film.width_mm, 200);
  ASSERT_EQ(config.object.artwork.size(), 2U);
  const ArtworkLayer& wood = config.object.artwork[0];
  EXPECT_EQ(wood.image, folder_ / "wood.png");
  EXPECT_EQ(wood.projection, Projection::kBox);
  EXPECT_EQ(wood.repeat, Repeat::kTile);
  EXPECT_EQ(wood.width_mm, 40);
  EXPECT_EQ(wood.height_mm, 0);
  EXPECT_FALSE(wood.at_mm.has_value());
  const ArtworkLayer& text = config.object.artwork[1];
  EXPECT_EQ(text.text, "No. 7");
  EXPECT_EQ(*text.at_mm, Vec3(1, -2, 3.5));
  EXPECT_EQ(*text.toward, Vec3(0, 0, -1));
  EXPECT_EQ(text.width_mm, 30);
  EXPECT_EQ(text.height_mm, 8);
  EXPECT_EQ(text.turn_deg, -15);
  EXPECT_TRUE(text.through);
  EXPECT_EQ(text.blend, Blend::kMultiply);
  EXPECT_EQ(text.text_color.g, 0);
}

TEST_F(ArtworkTables, OptionsMakeALayerOfTheirOwnOrChangeTheTopmost) {
  const std::string file = "[[artwork]]\nimage = 'a.png'\n";
  const JobConfig own = configured(
      file, {option("size_mm", "20"), option("image", "b.png"), option("at_mm", "-1,2,3")});
  ASSERT_EQ(own.object.artwork.size(), 2U);
  EXPECT_EQ(own.object.artwork[0].width_mm, 0);
  EXPECT_EQ(own.object.artwork[1].image, "b.png");
  EXPECT_EQ(own.object.artwork[1].width_mm, 20);
  EXPECT_EQ(*own.object.artwork[1].at_mm, Vec3(-1, 2, 3));
  const JobConfig changed = configured(file, {option("size_mm", "20")});
  ASSERT_EQ(changed.object.artwork.size(), 1U);
  EXPECT_EQ(changed.object.artwork[0].width_mm, 20);
  EXPECT_TRUE(contains(error("", {option("size_mm", "20")}), "needs artwork"));
}

TEST_F(ArtworkTables, WhatTheyCannotBeIsSaidWithItsPlace) {
  EXPECT_TRUE(contains(error("[[artwork]]\nimage = 'a.png'\nsize_mm = -3\n"), "job.toml:3"));
  EXPECT_TRUE(contains(error("[[artwork]]\nsize_mm = 0\n"), "W or W,H"));
  EXPECT_TRUE(contains(error("[[artwork]]\nat_mm = [1, 2]\n"), "three numbers"));
  EXPECT_TRUE(contains(error("[[artwork]]\nat_mm = 'x'\n"), "three numbers"));
  EXPECT_TRUE(contains(error("[[artwork]]\nthrough = 1\n"), "true or false"));
  EXPECT_TRUE(contains(error("[[artwork]]\nopacity = 1.5\n"), "0 to 1"));
  EXPECT_TRUE(contains(error("[[artwork]]\nprojection = 'flat'\n"), "planar, cylinder"));
  EXPECT_TRUE(contains(error("[[artwork]]\nturn_dg = 3\n"), "turn_deg"));
  EXPECT_TRUE(contains(error("[[artwork]]\nsize_mm = nan\n"), "size_mm"));
  EXPECT_TRUE(contains(error("artwork = 3\n"), "artwork"));
  std::string many;
  for (int n = 0; n < 70; ++n) many += "[[artwork]]\ntext = 'x'\n";
  EXPECT_TRUE(contains(error(many), "at most 64"));
}

TEST_F(ArtworkTables, ValuesAreWrittenAsTheyCanBeReadAgain) {
  ArtworkLayer layer;
  layer.at_mm = Vec3(1.25, -2, 3);
  layer.width_mm = 12.5;
  layer.height_mm = 7;
  layer.projection = Projection::kWrap;
  layer.through = true;
  layer.image = "a.png";
  const std::vector<std::string> values = layer_values(layer);
  JobConfig config;
  ASSERT_EQ(values.size(), layer_keys().size());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!values[k].empty())
      apply_settings(config, {parse_set("artwork[1]." + layer_keys()[k].name + "=" + values[k])});
  ASSERT_EQ(config.object.artwork.size(), 1U);
  EXPECT_EQ(layer_values(config.object.artwork[0]), values);
}

TEST_F(ArtworkTables, PartsOfASheet) {
  const JobConfig config =
      configured("[[part]]\njob = 'a.toml'\ncount = 3\n[[part]]\njob = 'b.stl'\n");
  ASSERT_EQ(config.parts.size(), 2U);
  EXPECT_EQ(config.parts[0].job, folder_ / "a.toml");
  EXPECT_EQ(config.parts[0].count, 3);
  EXPECT_EQ(config.parts[1].count, 1);
  EXPECT_TRUE(contains(error("[[part]]\njob = 'a'\ncount = 0\n"), "from 1 to 100"));
  EXPECT_TRUE(contains(error("[[part]]\njobs = 'a'\n"), "a job and a count"));
}

}  // namespace
}  // namespace hydrodip
