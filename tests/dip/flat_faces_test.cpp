// Flat faces that come down on the water all at once, and walls that end there.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "dip/flat_levels.h"
#include "dip/scheme.h"
#include "dip/tear_doubt.h"
#include "dip/zoo_shapes.h"

namespace hydrodip {
namespace {

TEST(FlatLevels, AreWhereEnoughOfTheObjectIsLevel) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 2), Vec3(10, 10, 12));
  EXPECT_EQ(flat_levels(box.positions, box.triangles, 1), (std::vector<double>{2, 12}));
  EXPECT_TRUE(flat_levels(box.positions, box.triangles, 401).empty());
  const shapes::Shape tilted = shapes::placed(box, Vec3(1, 0, 0));
  EXPECT_TRUE(flat_levels(tilted.positions, tilted.triangles, 1).empty());
  const shapes::Shape ball = shapes::full_sphere(20);
  EXPECT_TRUE(flat_levels(ball.positions, ball.triangles, 1).empty());
}

bool is_touched(const shapes::Shape& shape, const Vec2& plan, double from_mm, double to_mm) {
  const Surface surface(shape.positions, shape.triangles);
  return first_touch(surface, plan, Moment::at_depth(from_mm), plan, Moment::at_depth(to_mm))
      .has_value();
}

TEST(FlatFaces, AreTouchedInTheStepThatGoesBeyondThem) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 2), Vec3(10, 10, 12));
  EXPECT_FALSE(is_touched(box, Vec2(1, 2), 1.9, 2));
  EXPECT_TRUE(is_touched(box, Vec2(1, 2), 2, 2.1));
  EXPECT_TRUE(is_touched(box, Vec2(1, 2), 1.99, 2.001));
  // What rises is touched where it is met.
  const shapes::Shape cone = shapes::cone(10, 1);
  EXPECT_TRUE(is_touched(cone, Vec2(3, 0), 2, 3));
}

// A disc whose rim stands back by `step_up_mm`.
shapes::Shape stepped_disc(double step_up_mm) {
  return shapes::turned({{0, 0}, {14, 0}, {14, step_up_mm}, {26, step_up_mm}, {26, 8}, {0, 8}});
}

// Two blocks next to each other, one of which is higher.
shapes::Shape stepped_blocks(double step_up_mm) {
  shapes::Shape blocks = shapes::box({-22, -12, 0}, {-2, 12, 8});
  blocks.append(shapes::box({2, -12, step_up_mm}, {22, 12, 8 + step_up_mm}));
  return blocks;
}

DippedFilm dipped(const shapes::Shape& shape, double step_mm, double depth_mm) {
  const Surface surface(shape.positions, shape.triangles);
  FilmOptions film = shapes::zoo_film();
  film.elements = 5000;
  DipOptions options;
  options.step_mm = step_mm;
  return dip(make_film_mesh(film), shape.positions, shape.triangles, surface,
             make_trajectory({depth_mm}, shape.positions), options, RunContext())
      .film;
}

double furthest_apart(const DippedFilm& a, const DippedFilm& b) {
  double furthest = 0;
  for (std::size_t v = 0; v < a.state.size(); ++v)
    if (a.state[v] == VertexState::kAttached && b.state[v] == VertexState::kAttached)
      furthest = std::max(furthest, (a.position[v] - b.position[v]).norm());
  return furthest;
}

// Against steps of a tenth.
TEST(FlatFaces, LieAlikeWhereverInAStepTheyAreReached) {
  for (const double step_up_mm : {0.45, 0.4992, 0.4999, 0.5, 0.5004, 0.52}) {
    const shapes::Shape shape = stepped_disc(step_up_mm);
    const DippedFilm usual = dipped(shape, 0.1, 3), fine = dipped(shape, 0.01, 3);
    EXPECT_LT(furthest_apart(usual, fine), 0.01) << step_up_mm;
  }
}

// Film that has just been laid there is not stretched yet.
TEST(FlatFaces, LetNothingGoAsTheyComeDown) {
  for (const double step_up_mm : {0.3, 0.4, 0.4992, 0.5, 0.6})
    EXPECT_GT(first_let_go_mm(dipped(stepped_blocks(step_up_mm), 0.1, 1)), 1) << step_up_mm;
}

}  // namespace
}  // namespace hydrodip
