#include "job/prepare.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "contains.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// A funnel: point down, 10 mm deep per 10 mm of half width, 100 mm square on top at z = 50.
Object funnel() {
  Object object;
  object.positions = {{0, 0, 0}, {-50, -50, 50}, {50, -50, 50}, {50, 50, 50}, {-50, 50, 50}};
  object.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  object.material_of.assign(object.triangles.size(), 0);
  object.materials.emplace_back();
  return object;
}

std::string fit_error(const Object& object, const JobConfig& config) {
  RunContext context;
  try {
    require_fit(object, config, context);
  } catch (const InputError& error) {
    return error.what();
  }
  return "fits";
}

TEST(Fit, SaysByHowMuchAndHowToMend) {
  JobConfig config;
  config.film = {100, 300, FilmShape::kRectangle, 10, 1000};
  const std::string message = fit_error(funnel(), config);
  EXPECT_TRUE(contains(message, "100 mm wide (x), 20 mm more than the 80 mm")) << message;
  EXPECT_TRUE(contains(message, "--size 80 or less")) << message;
}

TEST(Fit, OnlyTheWetPartCounts) {
  JobConfig config;
  config.film = {100, 100, FilmShape::kRectangle, 10, 1000};
  EXPECT_NE(fit_error(funnel(), config), "fits");
  config.trajectory.depth_mm = 40;  // there the funnel is 80 mm wide
  EXPECT_EQ(fit_error(funnel(), config), "fits");
  config.trajectory.depth_mm = 41;
  EXPECT_TRUE(contains(fit_error(funnel(), config), "82 mm wide (x), 2 mm more"));
}

TEST(Fit, TheDiscIsMeasuredAcrossTheDiagonal) {
  JobConfig config;
  config.film = {162, 162, FilmShape::kDisc, 10, 1000};
  EXPECT_EQ(fit_error(funnel(), config), "fits");  // 141.42 of 142 mm
  config.film.width_mm = 161;                      // the smaller extent counts
  EXPECT_TRUE(contains(fit_error(funnel(), config), "141.42 mm across, 0.42 mm more"));
}

TEST(Fit, TheBathHasWidthLengthAndDepth) {
  JobConfig config;
  config.film = {400, 300, FilmShape::kRectangle, 10, 1000};
  config.bath = {90, 300, 150};  // turned with the sheet: 300 along x
  EXPECT_TRUE(contains(fit_error(funnel(), config), "100 mm long (y), 10 mm more than the 90 mm"));
  config.bath = {300, 300, 45};
  const std::string message = fit_error(funnel(), config);
  EXPECT_TRUE(contains(message, "50 mm deep in the water, 5 mm more than the 45 mm")) << message;
  EXPECT_TRUE(contains(message, "--depth")) << message;
  config.trajectory.depth_mm = 45;
  EXPECT_EQ(fit_error(funnel(), config), "fits");
}

TEST(Fit, WarnsAboutAFilmLargerThanTheBathAndAboutATightOne) {
  JobConfig config;
  RunContext context;
  config.film = {297, 420, FilmShape::kRectangle, 10, 1000};
  require_fit(funnel(), config, context);
  ASSERT_EQ(context.warnings().size(), 1u);
  EXPECT_TRUE(contains(context.warnings()[0], "larger than the bath"));

  RunContext tight;
  config.film = {122, 297, FilmShape::kRectangle, 10, 1000};
  require_fit(funnel(), config, tight);
  ASSERT_EQ(tight.warnings().size(), 1u);
  EXPECT_TRUE(contains(tight.warnings()[0], "Only 1 mm of free film"));
}

TEST(Fit, AHugeMisfitAsksForTheUnits) {
  Object object = funnel();
  for (Vec3& p : object.positions) p *= 1000;
  EXPECT_TRUE(contains(fit_error(object, JobConfig{}), "--units"));
}

TEST(LoadPosed, ScalesAreaAndVolumeWithTheObjectAndWarnsWhenItIsTiny) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "hydrodip_load_posed";
  std::filesystem::create_directories(folder);
  write_sample("box", make_sample("box"), folder);
  JobConfig config;
  config.model = folder / "box.obj";
  RunContext context;
  const LoadedObject full = load_posed(config, context);
  EXPECT_NEAR(full.health.volume_mm3, 40 * 40 * 15, 1);
  config.object.pose.size_mm = 4;
  const LoadedObject tiny = load_posed(config, context);
  EXPECT_NEAR(tiny.health.volume_mm3, 4 * 4 * 1.5, 1e-3);
  EXPECT_NEAR(tiny.health.area_mm2, full.health.area_mm2 / 100, 1e-3);
  ASSERT_FALSE(context.warnings().empty());
  EXPECT_TRUE(contains(context.warnings().back(), "largest extent is 4 mm"));
  std::filesystem::remove_all(folder);
}

TEST(Appearance, IsAskedForWithTheWayToMend) {
  Object object = funnel();
  try {
    require_appearance(object, "cup.stl");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "cup.stl"));
    EXPECT_TRUE(contains(error.what(), "UVs"));
  }
  object.uvs.resize(object.triangles.size());
  try {
    require_appearance(object, "cup.obj");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "--texture"));
  }
  EXPECT_NO_THROW(require_appearance(make_sample("box"), "box"));
}

TEST(BaseColor, IsReadAsSrgb) {
  JobConfig config;
  config.object.base_color = "#ff8000";
  const LinearColor color = base_color(config);
  EXPECT_EQ(color.r, 1);
  EXPECT_EQ(color.g, srgb8_to_linear(128));
  EXPECT_EQ(color.b, 0);
  EXPECT_EQ(color.a, 1);
}

}  // namespace
}  // namespace hydrodip
