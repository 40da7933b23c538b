#include "job/prepare.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "contains.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

TEST(PrepareObject, ScalesAreaAndVolumeWithTheObjectAndWarnsWhenItIsTiny) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "hydrodip_prepare_object";
  std::filesystem::create_directories(folder);
  write_sample("box", make_sample("box"), folder);
  RunContext context;
  ObjectOptions options;
  const PreparedObject full = prepare_object(folder / "box.obj", options, context);
  EXPECT_NEAR(full.health.volume_mm3, 40 * 40 * 15, 1);
  options.pose.size_mm = 4;
  const PreparedObject tiny = prepare_object(folder / "box.obj", options, context);
  EXPECT_NEAR(tiny.health.volume_mm3, 4 * 4 * 1.5, 1e-3);
  EXPECT_NEAR(tiny.health.area_mm2, full.health.area_mm2 / 100, 1e-3);
  ASSERT_FALSE(context.warnings().empty());
  EXPECT_TRUE(contains(context.warnings().back(), "largest extent is 4 mm"));
  std::filesystem::remove_all(folder);
}

TEST(PrepareObject, TakesAModelInMemoryAsItsFile) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "hydrodip_prepare_given";
  std::filesystem::create_directories(folder);
  write_sample("box", make_sample("box"), folder);
  const RunContext context;
  ObjectOptions options;
  options.pose.rotate_deg = Vec3(20, 0, 0);
  const PreparedObject read = prepare_object(folder / "box.obj", options, context);
  options.given =
      std::make_shared<const LoadedObject>(load_object(folder / "box.obj", options.load, context));
  std::filesystem::remove_all(folder);
  const PreparedObject given = prepare_object("nowhere.obj", options, context);
  EXPECT_EQ(given.posed.mesh().positions, read.posed.mesh().positions);
  EXPECT_EQ(given.posed.mesh().triangles, read.posed.mesh().triangles);
  EXPECT_EQ(given.health.volume_mm3, read.health.volume_mm3);
}

// A cube whose file says nothing of units.
PosedObject cube(double side_mm) {
  auto object = std::make_shared<Object>(make_sample("box"));
  const double scale = side_mm / object->bounds().size().maxCoeff();
  for (Vec3& p : object->positions) p *= scale;
  return {object, {}};
}

TEST(Size, IsAskedForWhereItIsLikelyMeantOtherwise) {
  for (const double asked_mm : {4.9, 1001.0})
    EXPECT_THROW(require_size(cube(asked_mm), {}, "part.stl"), InputError) << asked_mm;
  for (const double taken_mm : {5.1, 999.0})
    EXPECT_NO_THROW(require_size(cube(taken_mm), {}, "part.stl")) << taken_mm;
  ObjectOptions said;
  said.load.units = "mm";
  EXPECT_NO_THROW(require_size(cube(1.7), said, "part.stl"));
  said = {};
  said.pose.size_mm = 1.7;
  EXPECT_NO_THROW(require_size(cube(1.7), said, "part.stl"));
}

// Model programs that work in inches write files of millimetres' size without a word of it.
TEST(PrepareObject, SaysHowLargeASmallModelIsInInches) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "hydrodip_prepare_inches";
  std::filesystem::create_directories(folder);
  Object box = make_sample("box");  // 40 mm
  for (Vec3& p : box.positions) p *= 0.15;
  write_sample("inches", box, folder);
  const auto hinted = [&](const std::filesystem::path& file, const std::string& units,
                          double size_mm) {
    ObjectOptions options;
    options.load.units = units;
    options.pose.size_mm = size_mm;
    const RunContext context;
    prepare_object(file, options, context);
    for (const std::string& warning : context.warnings())
      if (contains(warning, "if it is in inches, it is 152 mm with --units in")) return true;
    return false;
  };
  EXPECT_TRUE(hinted(folder / "inches.obj", "", 0));
  EXPECT_FALSE(hinted(folder / "inches.obj", "mm", 0));
  EXPECT_FALSE(hinted(folder / "inches.obj", "", 6));
  for (Vec3& p : box.positions) p *= 2.6;  // 15.6 mm
  write_sample("small", box, folder);
  const RunContext context;
  prepare_object(folder / "small.obj", {}, context);
  for (const std::string& warning : context.warnings())
    EXPECT_FALSE(contains(warning, "--units")) << warning;
  std::filesystem::remove_all(folder);
}

TEST(PrepareObject, SaysWhereCoordinatesAreRounded) {
  ObjectOptions options;
  options.load.units = "mm";
  for (const double off_mm : {0.0, 1e4, 1e6}) {
    auto model = std::make_shared<LoadedObject>();
    model->object = make_sample("box");
    for (Vec3& p : model->object.positions) p.x() += off_mm;
    options.given = model;
    RunContext context;
    prepare_object("box.obj", options, context);
    int said = 0;
    for (const std::string& warning : context.warnings())
      said += contains(warning, "rounded to 0.1 mm") ? 1 : 0;
    EXPECT_EQ(said, off_mm > 1e5 ? 1 : 0) << off_mm;
  }
}

TEST(Memory, IsEnoughAtTheResolutionThatIsProposed) {
  DesignOptions options;
  options.film.width_mm = options.film.height_mm = 100000;
  options.dpi = 2400;
  try {
    require_memory(options, 1e10);
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    options.dpi = std::stod(text.substr(text.find("--dpi to ") + 9));
    EXPECT_GE(options.dpi, 1) << text;
  }
  EXPECT_NO_THROW(require_memory(options, 1e10));
  options.dpi += 1;
  EXPECT_THROW(require_memory(options, 1e10), InputError);
}

TEST(Memory, BlankSheetNeedsNone) {
  DesignOptions options;
  options.film.width_mm = options.film.height_mm = 100000;
  options.dpi = 2400;
  const auto cube = std::make_shared<const Object>(make_sample("box"));
  PreparedObject prepared{.posed = PosedObject(cube, {}),
                          .paint = model_paint(cube, {1, 1, 1, 1}),
                          .health = {},
                          .units = {},
                          .files = {},
                          .artwork = {},
                          .picture_problems = {}};
  prepared.health.area_mm2 = 6 * 20 * 20;
  const double inkable = inkable_mm2(prepared, options);
  EXPECT_GE(inkable, 6 * (20 + 2 * options.inverse.bleed_mm) * (20 + 2 * options.inverse.bleed_mm))
      << "six pieces with a bleed of their own";
  EXPECT_LT(inkable, 2 * 6 * 20 * 20);
  EXPECT_NO_THROW(require_memory(options, inkable));
  options.film.width_mm = options.film.height_mm = 30;
  EXPECT_EQ(inkable_mm2(prepared, options), 30 * 30) << "no more than there is";
}

TEST(Appearance, IsAskedForWithTheWayToMend) {
  Object object;
  object.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  object.triangles = {{0, 1, 2}};
  object.material_of = {0};
  object.materials.emplace_back();
  try {
    require_appearance(object, {}, "cup.stl");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "cup.stl"));
    EXPECT_TRUE(contains(error.what(), "UVs"));
  }
  object.uvs.resize(object.triangles.size());
  try {
    require_appearance(object, {}, "cup.obj");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "--texture"));
  }
  EXPECT_NO_THROW(require_appearance(make_sample("box"), {}, "box"));
}

TEST(Appearance, ArtworkIsOne) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "hydrodip_artwork_appearance";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "plate.obj") << "v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nf 1 2 3 4\n";
  ObjectOptions options;
  const RunContext context;
  EXPECT_THROW(require_appearance(prepare_object(folder / "plate.obj", options, context), "plate"),
               InputError);
  options.artwork.emplace_back();
  options.artwork[0].text = "7";
  const PreparedObject prepared = prepare_object(folder / "plate.obj", options, context);
  EXPECT_NO_THROW(require_appearance(prepared, "plate"));
  ASSERT_EQ(prepared.artwork.size(), 1U);
  EXPECT_NEAR(prepared.artwork[0].size_mm.y(), 40, 1e-6);  // a 7 is higher than wide
  options.artwork[0].text = "";
  options.artwork[0].image = folder / "nowhere.png";
  EXPECT_THROW(prepare_object(folder / "no_model_either.obj", options, context), InputError);
  std::filesystem::remove_all(folder);
}

TEST(Appearance, OfOneColourNamesThePictureThatIsMissing) {
  Object object = make_sample("box");
  object.textures.clear();
  for (Material& material : object.materials) {
    material.texture = -1;
    material.base_color = {0.5F, 0, 0, 1};
  }
  EXPECT_NO_THROW(require_appearance(object, {}, "box.obj"));
  try {
    require_appearance(object, {"wood.png is missing."}, "box.obj");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "wood.png"));
  }
}

}  // namespace
}  // namespace hydrodip
