// What film does that is stretched beyond what it bears.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "dip/dip.h"
#include "dip/tear_doubt.h"
#include "dip/zoo_shapes.h"

namespace hydrodip {
namespace {

DipResult dipped(const shapes::Shape& shape, const DipOptions& options, double depth_mm = 0,
                 const FilmOptions& film = shapes::zoo_film()) {
  const Surface surface(shape.positions, shape.triangles);
  RunContext context;
  return dip(make_film_mesh(film), shape.positions, shape.triangles, surface,
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

// From below: flat but for low waves. 5 mm thick.
shapes::Shape waves(double wave_mm, double height_mm) {
  constexpr int kCells = 60;
  constexpr double kHalf_mm = 15, kTop_mm = 5;
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
  std::vector<std::int32_t> rim(kCells);
  std::iota(rim.begin(), rim.end(), 0);
  for (int k = 0; k < kCells; ++k) rim.push_back(k * (kCells + 1) + kCells);
  for (int k = kCells; k > 0; --k) rim.push_back(kCells * (kCells + 1) + k);
  for (int k = kCells; k > 0; --k) rim.push_back(k * (kCells + 1));
  const auto first = std::int32_t(shape.positions.size()), count = std::int32_t(rim.size());
  for (const std::int32_t v : rim) {
    const Vec3& p = shape.positions[std::size_t(v)];
    shape.positions.push_back(Vec3(p.x(), p.y(), kTop_mm));
  }
  const std::int32_t middle = first + count;
  shape.positions.push_back(Vec3(0, 0, kTop_mm));
  for (std::int32_t k = 0; k < count; ++k) {
    const std::int32_t a = rim[std::size_t(k)], b = rim[std::size_t((k + 1) % count)];
    const std::int32_t c = first + k, d = first + (k + 1) % count;
    shape.triangles.push_back({a, b, d});
    shape.triangles.push_back({a, d, c});
    shape.triangles.push_back({c, d, middle});
  }
  return shape;
}

struct Laid {
  std::size_t triangles = 0, let_go = 0;
  double most_stretch = 0;
};

Laid laid_on_waves(double wave_mm, double height_mm, double step_mm, int elements) {
  FilmOptions film = shapes::zoo_film();
  film.elements = elements;
  const DippedFilm dipped_film =
      dipped(waves(wave_mm, height_mm), options_with(step_mm), 0.6, film).film;
  Laid laid;
  laid.let_go = let_go(dipped_film);
  for (std::size_t t = 0; t < dipped_film.torn.size(); ++t)
    laid.triangles += dipped_film.lies_on_object(t);
  for (std::size_t v = 0; v < dipped_film.state.size(); ++v)
    if (dipped_film.state[v] == VertexState::kAttached)
      laid.most_stretch = std::max(laid.most_stretch, dipped_film.stretch[v]);
  return laid;
}

// Between places where the object has touched, film that floats on is closed in, and the water
// comes to it from all sides at once. Over waves as flat as these nothing is stretched more
// than 1.03 times.
void expect_whole_on_waves(int elements) {
  for (const double height_mm : {0.02, 0.1, 0.3})
    for (const double wave_mm : {4.0, 5.0, 6.0, 8.0, 10.0, 14.0})
      for (const double step_mm : {0.05, 0.1, 0.3, 0.6}) {
        const Laid laid = laid_on_waves(wave_mm, height_mm, step_mm, elements);
        EXPECT_GT(laid.triangles, 250U);
        EXPECT_EQ(laid.let_go, 0U) << wave_mm << " " << height_mm << " " << step_mm;
        EXPECT_LT(laid.most_stretch, 1.05) << wave_mm << " " << height_mm << " " << step_mm;
      }
}

TEST(Tears, WhatIsLaidOnSomethingBluntDoesNotLetGo) { expect_whole_on_waves(3000); }
TEST(TearsSlow, NorDoesItOnFinerFilm) { expect_whole_on_waves(10000); }

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
