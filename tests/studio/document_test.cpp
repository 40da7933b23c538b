// Documents by themselves: what they may say, and what of a job they say.
#include "studio/document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "studio/api_error.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class DocumentTest : public testing::Test {
 protected:
  DocumentTest() {
    write_file(folder_ / "skin.png", "any");
    write_file(folder_ / "c.json", "any");
    write_file(elsewhere_ / "secret.icc", "any");
  }

  // The field that a document is refused by; "taken": it is not.
  std::string refused_by(const Json& document) const {
    try {
      config_of(document, files_);
    } catch (const ApiError& error) {
      return error.field;
    }
    return "taken";
  }

  TemporaryFolder folder_, elsewhere_;
  JobFiles files_{folder_.path()};
};

TEST_F(DocumentTest, SaysNothingOfTheMachine) {
  EXPECT_EQ(refused_by({{"output", {{"no_clobber", "on"}}}}), "output.no_clobber");
  EXPECT_EQ(refused_by({{"stage", {{"port", "/dev/ttyS0"}}}}), "stage.port");
  JobConfig config;
  apply_machine_values({{"output.no_clobber", "on"}, {"film.width_mm", 77}}, config);
  EXPECT_NE(config.design.film.width_mm, 77);
  EXPECT_EQ(machine_values_of(config), Json({{"output.no_clobber", "on"}}));
  EXPECT_EQ(document_of(config, files_), Json::object());
}

TEST_F(DocumentTest, NamesTheJobsFilesAlone) {
  EXPECT_EQ(refused_by({{"artwork", Json::array({{{"image", "skin.png"}}})}}), "taken");
  EXPECT_EQ(refused_by({{"ink", {{"profile", "secret.icc"}}}}), "ink.profile");
  EXPECT_EQ(refused_by({{"artwork", Json::array({{{"image", "secret.icc"}}})}}),
            "artwork[1].image");
  EXPECT_EQ(refused_by({{"dips", Json::array({{{"correction", "secret.icc"}}})}}),
            "dip[1].correction");
  const std::string secret = (elsewhere_ / "secret.icc").string();
  EXPECT_NE(refused_by({{"ink", {{"profile", secret}}}}), "taken");
  EXPECT_NE(refused_by({{"dips", Json::array({{{"correction", secret}}})}}), "taken");
  // That it has is said where it lies.
  const JobConfig config = config_of({{"dips", Json::array({{{"correction", "c.json"}}})}}, files_);
  EXPECT_EQ(config.dips.at(0).correction, folder_ / "c.json");
}

TEST_F(DocumentTest, HasRoomForWhatAPageKeepsAndNoMore) {
  const auto page = [](std::size_t bytes) {
    return Json{{"page", {{"kept", std::string(bytes, 'x')}}}};
  };
  EXPECT_EQ(refused_by(page(65000)), "taken");
  EXPECT_EQ(refused_by(page(66000)), "page");
  EXPECT_EQ(refused_by({{"page", 3}}), "page");
  EXPECT_EQ(refused_by({{"name", std::string(kLongestName, 'x')}}), "taken");
  EXPECT_EQ(refused_by({{"name", std::string(kLongestName + 1, 'x')}}), "name");
}

TEST_F(DocumentTest, WaysHaveRowsOfSixNumbers) {
  const auto path = [](const Json& row) { return Json{{"path", Json::array({row, row})}}; };
  for (const int length : {0, 5, 7, 12})
    EXPECT_EQ(refused_by(path(Json(std::vector<double>(std::size_t(length), 0)))), "path")
        << length;
  EXPECT_EQ(refused_by({{"path", Json::array({{0, 0, 0, 0, 0, 0}, {9, 0, 0, 0, 0, 0}})}}), "taken");
}

// A dip of which nothing is said is one all the same.
TEST_F(DocumentTest, HasAsManyDipsAsItsList) {
  EXPECT_EQ(config_of({{"dips", {Json::object(), Json::object()}}}, files_).dips.size(), 2U);
}

TEST_F(DocumentTest, SaysOfDipsAndLayersWhatTheJobDoes) {
  JobConfig config;
  config.object.artwork.emplace_back().text = "Hi";
  config.dips.resize(2);
  DipEntry& first = config.dips[0];
  first.down = ModelSide::kPlusX;
  first.rotate_deg = Vec3(1, 2, 3);
  first.path = {{}, {.lower_mm = 9, .shift_x_mm = 2}};
  first.locked = true;
  first.correction = folder_ / "c.json";
  config.dips[1].depth_mm = 7;
  const Json document = document_of(config, files_);
  EXPECT_EQ(document["artwork"], Json::array({{{"text", "Hi"}}}));
  EXPECT_EQ(document["dips"][0]["locked"], true);
  EXPECT_EQ(document["dips"][0]["path"].size(), 2U);
  EXPECT_EQ(document["dips"][1], Json({{"depth_mm", 7.0}}));
  const JobConfig again = config_of(document, files_);
  ASSERT_EQ(again.dips.size(), 2U);
  EXPECT_EQ(again.dips[0].down, ModelSide::kPlusX);
  EXPECT_EQ(*again.dips[0].rotate_deg, Vec3(1, 2, 3));
  EXPECT_EQ(again.dips[0].path.at(1).shift_x_mm, 2);
  EXPECT_TRUE(again.dips[0].locked);
  EXPECT_EQ(again.dips[0].correction, folder_ / "c.json");
  EXPECT_EQ(again.object.artwork.at(0).text, "Hi");
  config.parts.push_back({"toy.stl", 2});
  EXPECT_THROW(document_of(config, files_), InputError);
}

TEST_F(DocumentTest, EveryFileBesideTheModelIsVisited) {
  JobConfig config;
  config.model = "toy.obj";
  config.object.load.texture = "skin.png";
  config.object.artwork.emplace_back().image = "logo.svg";
  config.dips.emplace_back().correction = "c.json";
  std::vector<std::string> visited;
  each_side_file(config, [&](std::filesystem::path& file) {
    visited.push_back(file.string());
    file = "new/" + file.string();
  });
  std::ranges::sort(visited);
  EXPECT_EQ(visited, (std::vector<std::string>{"c.json", "logo.svg", "skin.png"}));
  EXPECT_EQ(config.model, "toy.obj");
  EXPECT_EQ(config.object.load.texture, "new/skin.png");
  EXPECT_EQ(config.object.artwork[0].image, "new/logo.svg");
  EXPECT_EQ(config.dips[0].correction, "new/c.json");
}

TEST_F(DocumentTest, AJobIsCalledByItsOwnNameOrItsModels) {
  EXPECT_EQ(name_of_job({{"name", "helmet"}, {"object", {{"file", "a/toy.obj"}}}}), "helmet");
  EXPECT_EQ(name_of_job({{"name", ""}, {"object", {{"file", "a/toy.obj"}}}}), "toy");
  EXPECT_EQ(name_of_job(Json::object()), "untitled");
}

}  // namespace
}  // namespace hydrodip
