#include <gtest/gtest.h>

#include <limits>

#include "base/file.h"
#include "full_disk.h"
#include "hydrodip/hydrodip.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

Object triangle() {
  Object object;
  object.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  object.triangles = {{0, 1, 2}};
  return object;
}

TEST(ModelFrom, TakesPlainArrays) {
  const Model model = model_from(triangle());
  EXPECT_NEAR(model.health.area_mm2, 50, 1e-12);
  EXPECT_FALSE(paint_of(model)->says_anything());
}

TEST(ModelFrom, RefusesWhatHasNoMeaning) {
  Object beyond = triangle();
  beyond.triangles[0][2] = 3;
  EXPECT_THROW(model_from(beyond), InputError);
  Object negative = triangle();
  negative.triangles[0][0] = -1;
  EXPECT_THROW(model_from(negative), InputError);
  Object infinite = triangle();
  infinite.positions[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(model_from(infinite), InputError);
  Object uneven = triangle();
  uneven.uvs.resize(2);
  EXPECT_THROW(model_from(uneven), InputError);
  Object textureless = triangle();
  textureless.materials.resize(1);
  textureless.materials[0].texture = 0;
  EXPECT_THROW(model_from(textureless), InputError);
  EXPECT_THROW(model_from(Object()), InputError);
}

TEST(Pose, LeavesTheModelAlone) {
  const Model model = sample("box");
  const std::vector<Vec3> before = model.object->positions;
  const PosedObject posed = pose(model, {.size_mm = 80, .rotate_deg = {20, 30, 40}});
  EXPECT_EQ(model.object->positions, before);
  EXPECT_EQ(&posed.object(), model.object.get());  // shared
  EXPECT_NEAR(posed.mesh().bounds().min.z(), 0, 1e-12);
}

TEST(Simulate, ShowsEveryStep) {
  SimulationOptions options;
  options.film.width_mm = options.film.height_mm = 120;
  options.film.elements = 1000;
  options.trajectory.depth_mm = 5;
  options.dip.step_mm = 1;
  int last = -1, steps = 0;
  simulate(pose(sample("sphere")), options, {}, [&](int step, int of, auto&&...) {
    EXPECT_EQ(step, last + 1);
    last = step;
    steps = of;
  });
  EXPECT_EQ(steps, 5);
  EXPECT_EQ(last, 5);
}

TEST(Write, AnEarlierFileStaysUntilTheNewOneIsWhole) {
  const TemporaryFolder folder;
  write_file(folder / "a.png", "earlier");
  {
    const FullDisk disk(20);
    EXPECT_THROW(write_png(folder / "a.png", Image(64, 64)), InputError);
    EXPECT_THROW(write_png(folder / "b.png", Image(64, 64)), InputError);
  }
  EXPECT_EQ(read_file(folder / "a.png").size(), 7U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Render, AnEmptyFinishIsRefused) {
  EXPECT_THROW(render(Finish(paint_of(sample("box")), {})), InputError);
}

}  // namespace
}  // namespace hydrodip
