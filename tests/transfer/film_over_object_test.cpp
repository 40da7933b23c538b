// Film over the object, triangle on triangle, against rays that are followed one by one.
#include "transfer/film_over_object.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

SurfacePoint some_point(const TriangleMesh& object, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  double u = share(random), v = share(random);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return {int(random() % object.triangles.size()), u, v};
}

struct Seen {
  int covered = 0, torn = 0, bare = 0;
};

// The film at points of the object by both ways; where its outline is no further than rounding,
// they may differ.
Seen compare(const fixtures::Dipped& dipped, int points) {
  std::mt19937 random(3);
  Seen seen;
  int differ = 0;
  for (int n = 0; n < points; ++n) {
    const SurfacePoint point = some_point(dipped.object, random);
    const Vec3 position = position_at(dipped.object, point);
    const Vec3 normal = face_normal(dipped.object, point.triangle);
    const FilmMap::Lying by_rays = dipped.map->lying_at(position, normal);
    const FilmMap::Lying lying = dipped.map->lying_at(point);
    EXPECT_EQ(lying.film.has_value(), dipped.map->to_film(point).has_value());
    if (lying.film.has_value() != by_rays.film.has_value() ||
        lying.hold.has_value() != by_rays.hold.has_value()) {
      ++differ;
      continue;
    }
    ++(lying.film ? seen.covered : lying.hold ? seen.torn : seen.bare);
    if (lying.film && (*lying.film - *by_rays.film).norm() > 1e-4) ++differ;
    if (!lying.hold) continue;
    EXPECT_NEAR(lying.hold->stretch, by_rays.hold->stretch, 1e-3);
    EXPECT_EQ(lying.hold->let_go, by_rays.hold->let_go);
  }
  EXPECT_LE(differ, points / 2000);
  return seen;
}

std::unique_ptr<fixtures::Dipped> dipped(const shapes::Shape& shape, int elements, double step_mm,
                                         double depth_mm) {
  return fixtures::mapped(
      fixtures::plain_object(shape),
      exact::dip_shape(shape, exact::disc_film(elements), exact::untearing(step_mm, depth_mm)));
}

TEST(FilmOverObject, IsWhatRaysMeetOverARoundObject) {
  const Seen seen = compare(*dipped(shapes::sphere_bowl(30, 29.5), 10000, 0.2, 16), 20000);
  EXPECT_GT(seen.covered, 3000);
  EXPECT_GT(seen.bare, 3000);
}

TEST(FilmOverObject, IsWhatRaysMeetOverTrianglesThatAreMuchLargerThanTheFilms) {
  const auto slab = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(5000));
  EXPECT_GT(compare(*slab, 20000).covered, 1000);
  const TriangleMesh film{slab->film.position, slab->film.mesh().triangles};
  const Surface sheet(film.positions, film.triangles);
  const FilmOverObject over(slab->object, film, sheet, 1);
  EXPECT_FALSE(over.nearest({0, 0.3, 0.3}).is_known);
}

TEST(FilmOverObject, IsWhatRaysMeetOverTrianglesThatAreMuchSmallerThanTheFilms) {
  EXPECT_GT(compare(*dipped(shapes::sphere_bowl(28, 24, 300, 400), 1000, 0.5, 10), 20000).covered,
            2000);
}

// Over edges film is looked for along other directions.
TEST(FilmOverObject, IsWhatRaysMeetAtEdges) {
  EXPECT_GT(compare(*dipped(shapes::cone(24, 1, 60, 7), 10000, 0.2, 16), 20000).covered, 2000);
}

TEST(FilmOverObject, IsWhatRaysMeetWhereFilmIsTorn) {
  const shapes::Shape sphere = shapes::sphere_bowl(30, 29.5);
  DippedFilm film = exact::dip_shape(sphere, exact::disc_film(10000), exact::untearing(0.2, 16));
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t)
    if (film.mesh().u[std::size_t(film.mesh().triangles[t][0])].x() > 3.3) film.torn[t] = 1;
  const Seen seen =
      compare(*fixtures::mapped(fixtures::plain_object(sphere), std::move(film)), 20000);
  EXPECT_GT(seen.covered, 1500);
  EXPECT_GT(seen.torn, 1000);
}

// Film that looks away is of no use, and hides what lies behind it.
TEST(FilmOverObject, SeesTheNearerSideFirst) {
  const Object slab = fixtures::slab();
  const auto film_at = [](double height_mm, bool upwards) {
    TriangleMesh film;
    film.positions = {{-30, -30, height_mm}, {30, -30, height_mm}, {0, 30, height_mm}};
    film.triangles = {upwards ? Triangle{0, 1, 2} : Triangle{0, 2, 1}};
    return film;
  };
  const SurfacePoint below{0, 0.3, 0.3};  // the slab's bottom, at 0, which faces down
  ASSERT_LT(face_normal(slab, 0).z(), -0.9);
  const auto nearest = [&](const std::vector<TriangleMesh>& parts) {
    TriangleMesh all;
    for (const TriangleMesh& part : parts) {
      const auto first = std::int32_t(all.positions.size());
      all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
      for (const Triangle& t : part.triangles)
        all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    const Surface sheet(all.positions, all.triangles);
    const FilmOverObject over(slab, all, sheet, 2);
    const FilmOverObject::Nearest found = over.nearest(below);
    EXPECT_TRUE(found.is_known);
    return found.hit ? found.hit->triangle : -1;
  };
  EXPECT_EQ(nearest({film_at(-0.5, true)}), 0);
  EXPECT_EQ(nearest({film_at(0.5, true)}), 0);
  EXPECT_EQ(nearest({film_at(-0.5, false)}), -1);
  EXPECT_EQ(nearest({film_at(-2.5, true)}), -1);  // out of reach
  EXPECT_EQ(nearest({film_at(-0.5, true), film_at(0.3, true)}), 1);
  EXPECT_EQ(nearest({film_at(-0.3, true), film_at(0.5, true)}), 0);
  EXPECT_EQ(nearest({film_at(-0.5, true), film_at(-0.3, false)}), -1);
  EXPECT_EQ(nearest({film_at(-0.5, true), film_at(0.3, false)}), 0);
}

TEST(FilmOverObject, EndsWhereFilmIsOutOfReach) {
  const Object slab = fixtures::slab();
  TriangleMesh film;  // the further from the slab's bottom the further towards +y
  film.positions = {{-90, -30, -0.5}, {90, -30, -0.5}, {0, 90, -8.5}};
  film.triangles = {{0, 1, 2}};
  const Surface sheet(film.positions, film.triangles);
  const FilmOverObject over(slab, film, sheet, 2);
  std::mt19937 random(4);
  int within = 0, beyond = 0;
  for (int n = 0; n < 4000; ++n) {
    const SurfacePoint point = some_point(slab, random);
    if (face_normal(slab, point.triangle).z() > -0.9) continue;
    const double away_mm = 0.5 + (position_at(slab, point).y() + 30) / 15;
    if (std::abs(away_mm - 2) < 1e-4) continue;
    const FilmOverObject::Nearest nearest = over.nearest(point);
    ASSERT_TRUE(nearest.is_known);
    ASSERT_EQ(nearest.hit.has_value(), away_mm < 2);
    ++(nearest.hit ? within : beyond);
    if (nearest.hit) {
      EXPECT_NEAR(nearest.hit->t, away_mm, 1e-5);
    }
  }
  EXPECT_GT(within, 50);
  EXPECT_GT(beyond, 50);
}

// Whoever asks first keeps what it found; all get the same.
TEST(FilmOverObject, IsTheSameForAllThreads) {
  const auto sphere = dipped(shapes::sphere_bowl(30, 29.5), 3000, 0.5, 10);
  const auto ask = [&](std::vector<double>& answers) {
    std::mt19937 random(8);
    for (int n = 0; n < 20000; ++n) {
      const auto film = sphere->map->to_film(some_point(sphere->object, random));
      answers.push_back(film ? film->x() : 1e9);
    }
  };
  std::array<std::vector<double>, 4> answers;
  std::vector<std::thread> threads;
  threads.reserve(answers.size());
  for (auto& own : answers) threads.emplace_back([&ask, &own] { ask(own); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& own : answers) EXPECT_EQ(own, answers[0]);
}

}  // namespace
}  // namespace hydrodip
