// Film and trapped air: what is under air stays bare, what is beside it is as before.
#include <gtest/gtest.h>

#include <cmath>

#include "coat/dipped_object.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

// A cup, mouth down: 18 mm outer and 15 mm inner radius, 25 mm deep.
std::shared_ptr<const Object> cup() {
  const std::vector<Vec2> profile = {{15, 0}, {18, 0}, {18, 28}, {0, 28}};
  shapes::Shape shape =
      shapes::revolve([&](double s) { return profile[std::size_t(std::lround(3 * s))]; }, 3, 96);
  const std::vector<Vec2> inside = {{0, 25}, {15, 25}, {15, 0}};
  shape.append(
      shapes::revolve([&](double s) { return inside[std::size_t(std::lround(2 * s))]; }, 2, 96));
  auto object = std::make_shared<Object>();
  object->positions = shape.positions;
  object->triangles = shape.triangles;
  object->material_of.assign(object->triangles.size(), 0);
  object->materials.resize(1);
  return object;
}

DippedObject dipped(int air_cells) {
  FilmOptions film;
  film.width_mm = film.height_mm = 120;
  film.elements = 10000;
  DipOptions options;
  options.step_mm = 0.5;
  options.material.tear_stretch = 0;
  Timings timings;
  return dip_object(PosedObject(cup(), PoseOptions()),
                    std::make_shared<const FilmMesh>(make_film_mesh(film)),
                    Trajectory::straight_down(8), options, timings, RunContext(), {},
                    {.options = {air_cells}, .found = {}});
}

int attached_inside(const DippedFilm& film) {
  int count = 0;
  for (std::size_t v = 0; v < film.position.size(); ++v)
    if (film.state[v] == VertexState::kAttached && film.position[v].head<2>().norm() < 14.5)
      ++count;
  return count;
}

TEST(DipWithAir, NothingLiesInTheCup) {
  const DippedObject with = dipped(100000);
  ASSERT_EQ(with.air->pockets.size(), 1U);
  EXPECT_EQ(attached_inside(*with.film), 0);
  int floating = 0;
  for (std::size_t v = 0; v < with.film->position.size(); ++v) {
    const Vec3& p = with.film->position[v];
    if (p.head<2>().norm() > 14) continue;
    EXPECT_NEAR(p.z(), 0, 0.01);  // where the water stands
    ++floating;
  }
  EXPECT_GT(floating, 50);
  // Outside, film lies on the wall.
  int outside = 0;
  for (std::size_t v = 0; v < with.film->position.size(); ++v)
    outside += with.film->state[v] == VertexState::kAttached && with.film->position[v].z() > 4;
  EXPECT_GT(outside, 50);
}

TEST(DipWithAir, WhereItIsNotLookedForWaterRisesThroughIt) {
  const DippedObject without = dipped(0);
  EXPECT_TRUE(without.air->pockets.empty());
  int floating = 0;
  for (const Vec3& p : without.film->position) {
    if (p.head<2>().norm() > 10) continue;
    EXPECT_NEAR(p.z(), 8, 0.01);
    ++floating;
  }
  EXPECT_GT(floating, 20);
}

}  // namespace
}  // namespace hydrodip
