// What film does that is stretched beyond what it bears.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "dip/dip.h"
#include "dip/tear_doubt.h"
#include "dip/zoo_shapes.h"

namespace hydrodip {
namespace {

DipResult dipped(const shapes::Shape& shape, const DipOptions& options, double depth_mm = 0) {
  const Surface surface(shape.positions, shape.triangles);
  RunContext context;
  return dip(make_film_mesh(shapes::zoo_film()), shape.positions, shape.triangles, surface,
             make_trajectory({depth_mm}, shape.positions), options, context);
}

DipOptions options_with(double step_mm) {
  DipOptions options;
  options.step_mm = step_mm;
  options.asks_what_moves = true;
  return options;
}

std::size_t let_go(const DippedFilm& film) {
  return std::size_t(std::count_if(film.torn_at_mm.begin(), film.torn_at_mm.end(),
                                   [](double at) { return std::isfinite(at); }));
}

// From below: flat but for low waves.
shapes::Shape waves(double wave_mm, double height_mm) {
  constexpr int kCells = 60;
  constexpr double kHalf_mm = 15;
  shapes::Shape shape;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const double x = kHalf_mm * (2.0 * i / kCells - 1), y = kHalf_mm * (2.0 * j / kCells - 1);
      const double wave = std::cos(2 * std::numbers::pi * x / wave_mm) *
                          std::cos(2 * std::numbers::pi * y / wave_mm);
      shape.positions.push_back({x, y, 0.002 * (x * x + y * y) + 0.5 * height_mm * (1 - wave)});
    }
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const std::int32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
      shape.triangles.push_back({a, b + 1, a + 1});
      shape.triangles.push_back({a, b, b + 1});
    }
  return shape;
}

// Between two places where the object has touched, a vertex that floats on is pinched.
TEST(Tears, WhatIsLaidOnSomethingBluntDoesNotLetGo) {
  struct Case {
    double wave_mm, height_mm, step_mm;
  };
  for (const Case& c : {Case{5, 0.1, 0.6}, Case{8, 0.1, 0.1}, Case{4, 0.3, 0.6}, Case{6, 0.3, 0.3},
                        Case{8, 0.3, 0.3}, Case{10, 0.3, 0.1}}) {
    const DippedFilm film =
        dipped(waves(c.wave_mm, c.height_mm), options_with(c.step_mm), 0.6).film;
    std::size_t laid = 0;
    for (std::size_t t = 0; t < film.torn.size(); ++t) laid += film.lies_on_object(t);
    EXPECT_GT(laid, 50U);
    EXPECT_EQ(let_go(film), 0U) << c.wave_mm << " " << c.height_mm << " " << c.step_mm;
  }
}

// Over the sphere's equator film is torn off all around.
TEST(Tears, WhatStaysAfloatHangsTogetherWithTheRim) {
  const DippedFilm film = dipped(shapes::full_sphere(22), options_with(0.5)).film;
  ASSERT_GT(let_go(film), 50U);
  const FilmMesh& mesh = film.mesh();
  const auto floats = [&](std::size_t t) {
    const Triangle& v = mesh.triangles[t];
    return !film.torn[t] && std::any_of(v.begin(), v.end(), [&](std::int32_t w) {
      return film.state[std::size_t(w)] == VertexState::kUnattached;
    });
  };
  std::vector<std::uint8_t> reached(film.torn.size(), 0);
  std::vector<std::size_t> front;
  for (std::size_t t = 0; t < reached.size(); ++t)
    for (const std::int32_t v : mesh.triangles[t])
      if (floats(t) && mesh.on_rim[std::size_t(v)] && !reached[t]) {
        reached[t] = 1;
        front.push_back(t);
      }
  while (!front.empty()) {
    const std::size_t t = front.back();
    front.pop_back();
    for (const std::int32_t next : mesh.neighbor[t]) {
      if (next < 0 || reached[std::size_t(next)] || !floats(std::size_t(next))) continue;
      reached[std::size_t(next)] = 1;
      front.push_back(std::size_t(next));
    }
  }
  for (std::size_t t = 0; t < reached.size(); ++t) EXPECT_EQ(floats(t), reached[t] != 0) << t;
}

// Beyond a cut all around, nothing of what is whole below it can depend on how torn film falls.
TEST(Tears, BelowTheFirstTearNothingDependsOnThem) {
  const DippedFilm film = dipped(shapes::full_sphere(22), options_with(0.5)).film;
  ASSERT_EQ(film.moved_mm.size(), film.position.size());
  int below = 0;
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    if (film.state[v] != VertexState::kAttached || film.position[v].z() > 8) continue;
    EXPECT_EQ(film.moved_mm[v], 0);
    ++below;
  }
  EXPECT_GT(below, 100);
}

TEST(Tears, WhereNothingTearsNobodyAsksWhatMoves) {
  const DippedFilm film = dipped(shapes::full_sphere(22), options_with(0.5), 5).film;
  EXPECT_TRUE(film.excess.empty());
  EXPECT_TRUE(film.moved_mm.empty());
  EXPECT_EQ(let_go(film), 0U);
}

// Film between the legs of a table hangs on their walls.
TEST(Tears, FilmThatMovesIsNotPromised) {
  shapes::Shape table = shapes::box({-25, -20, 22}, {25, 20, 26});
  for (const double x : {-22.0, 17.0})
    for (const double y : {-17.0, 12.0}) table.append(shapes::box({x, y, 0}, {x + 5, y + 5, 23}));
  const DippedFilm film = dipped(table, options_with(0.5)).film;
  ASSERT_FALSE(film.moved_mm.empty());
  int moved = 0;
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    if (!(film.moved_mm[v] > kMoved_mm)) continue;
    EXPECT_GT(film.excess[v], 0);
    moved += film.state[v] == VertexState::kAttached;
  }
  EXPECT_GT(moved, 0);
}

// A dip passes through every shallower one: it takes back nothing of what those promise that end
// before any film lets go.
TEST(Tears, WhatAShallowerDipPromisesIsPromised) {
  const shapes::Shape grooved = shapes::turned(
      {{0, 0}, {8, 0.8}, {9, 1}, {10, 2.5}, {16, 2.5}, {17, 1.4}, {30, 12}, {31, 30}, {0, 30}});
  const DippedFilm deep = dipped(grooved, options_with(0.5)).film;
  const double first_mm = first_let_go_mm(deep);
  ASSERT_TRUE(std::isfinite(first_mm));
  const double before_mm = 0.5 * std::ceil(2 * first_mm - 1) - 0.5;
  ASSERT_GT(before_mm, 0);
  const DippedFilm shallow = dipped(grooved, options_with(0.5), before_mm).film;
  // At the water line film is measured before all around it lies.
  std::vector<std::uint8_t> lies(shallow.position.size(), 1);
  for (std::size_t t = 0; t < shallow.torn.size(); ++t)
    if (!shallow.lies_on_object(t))
      for (const std::int32_t v : shallow.mesh().triangles[t]) lies[std::size_t(v)] = 0;
  int promised = 0;
  for (std::size_t v = 0; v < deep.position.size(); ++v) {
    if (!lies[v] || shallow.excess_of(std::int32_t(v)) > 0) continue;
    EXPECT_LE(deep.excess_of(std::int32_t(v)), 0) << shallow.position[v].transpose();
    ++promised;
  }
  EXPECT_GT(promised, 300);
}

// What a first dip found decides when film lets go in the next.
TEST(Tears, LetGoWhenToldTo) {
  DipOptions options = options_with(0.5);
  const DippedFilm first = dipped(shapes::full_sphere(22), options).film;
  options.tears_at_mm = first.torn_at_mm;
  options.moved_mm = first.moved_mm;
  const DippedFilm second = dipped(shapes::full_sphere(22), options).film;
  EXPECT_EQ(first.torn, second.torn);
  EXPECT_EQ(first.moved_mm, second.moved_mm);
  for (std::size_t v = 0; v < first.position.size(); ++v)
    EXPECT_LT((first.position[v] - second.position[v]).norm(), 1e-9) << v;
}

}  // namespace
}  // namespace hydrodip
