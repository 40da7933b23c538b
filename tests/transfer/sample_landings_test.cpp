// Film over the object, triangle on triangle, against lines that are followed one by one.
#include "transfer/sample_landings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

// Some way outside of all films here.
SampleGrid whole_sheet(int samples) {
  const double step_mm = 60.0 / samples;
  return {Vec2(-30 + 0.5 * step_mm, 30 - 0.5 * step_mm), step_mm, samples, samples};
}

SurfacePoint landing(const SampleLandings& landings, int column, int row) {
  return landings.landing(landings.pair_at(column, row), column, row, 1).first;
}

struct Found {
  int by_drawing = 0, by_lines = 0;
};

// Every sample that is drawn, to where its line ends; and how many each has.
Found compare(const fixtures::Dipped& dipped, int samples) {
  const SampleGrid grid = whole_sheet(samples);
  const SampleLandings landings(*dipped.map, grid, dipped.map->lying());
  Found found;
  double largest_mm = 0, outside = 0;  // of the triangle of the object
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto line = dipped.map->to_object(grid.at(column, row));
      found.by_lines += line.has_value();
      if (landings.pair_at(column, row) == SampleLandings::kNone) continue;
      ++found.by_drawing;
      if (!line) {
        // A sample on the outline belongs to the film; a line begins in one of two triangles there.
        EXPECT_TRUE(dipped.map->nearest_covered(grid.at(column, row), 1e-5));
        continue;
      }
      const SurfacePoint point = landing(landings, column, row);
      outside = std::max({outside, -point.u, -point.v, point.u + point.v - 1});
      largest_mm =
          std::max(largest_mm,
                   (position_at(dipped.object, point) - position_at(dipped.object, *line)).norm());
    }
  EXPECT_LT(largest_mm, 1e-5);
  EXPECT_LT(outside, 1e-4);  // of lines in floats
  return found;
}

std::unique_ptr<fixtures::Dipped> dipped_sphere() {
  const shapes::Shape sphere = shapes::sphere_bowl(30, 29.5);
  return fixtures::mapped(
      fixtures::plain_object(sphere),
      exact::dip_shape(sphere, exact::disc_film(10000), exact::untearing(0.2, 16)));
}

TEST(SampleLandings, IsWhereLinesMeetARoundObject) {
  const Found found = compare(*dipped_sphere(), 301);
  EXPECT_GT(found.by_lines, 10000);
  EXPECT_GT(found.by_drawing, 0.999 * found.by_lines);
}

TEST(SampleLandings, IsWhereLinesMeetTrianglesThatAreMuchLargerThanTheFilms) {
  const Found found =
      compare(*fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(5000)), 307);
  EXPECT_GT(found.by_lines, 0.4 * 307 * 307);
  EXPECT_EQ(found.by_drawing, found.by_lines);
}

TEST(SampleLandings, IsWhereLinesMeetTrianglesThatAreMuchSmallerThanTheFilms) {
  const shapes::Shape sphere = shapes::sphere_bowl(28, 24, 300, 400);
  const Found found = compare(*fixtures::mapped(fixtures::plain_object(sphere),
                                                exact::dip_shape(sphere, exact::disc_film(1000),
                                                                 exact::untearing(0.5, 10))),
                              211);
  EXPECT_GT(found.by_lines, 5000);
  EXPECT_GT(found.by_drawing, 0.99 * found.by_lines);
}

// A pyramid's edges: film lies flat over them, and lines on either side run to one face each.
TEST(SampleLandings, IsWhereLinesMeetBothFacesOfAnEdge) {
  const shapes::Shape cone = shapes::cone(24, 1, 60, 7);
  const Found found = compare(
      *fixtures::mapped(fixtures::plain_object(cone),
                        exact::dip_shape(cone, exact::disc_film(10000), exact::untearing(0.2, 16))),
      301);
  EXPECT_GT(found.by_lines, 5000);
  EXPECT_GT(found.by_drawing, 0.99 * found.by_lines);
}

TEST(SampleLandings, TakesTheNearerSideOfASlot) {
  const Vec3 reach(fixtures::kHalfSide_mm, fixtures::kHalfSide_mm, 0);
  shapes::Shape fork = shapes::box(-reach, reach + Vec3(0, 0, 8));
  fork.append(shapes::box(-reach - Vec3(0, 0, 9), reach - Vec3(0, 0, 0.1)));
  DippedFilm film = fixtures::film_on_slab(2000);
  for (Vec3& at : film.position) at.z() -= 0.03;
  const auto dipped = fixtures::mapped(fixtures::plain_object(fork), std::move(film));
  const SampleGrid grid = whole_sheet(101);
  const SampleLandings landings(*dipped->map, grid, dipped->map->lying());
  int found = 0, lying = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      lying += dipped->map->to_object(grid.at(column, row)).has_value();
      if (landings.pair_at(column, row) == SampleLandings::kNone) continue;
      ++found;
      const Vec3 at = position_at(dipped->object, landing(landings, column, row));
      EXPECT_NEAR(at.z(), 0, 1e-9);
    }
  EXPECT_GT(lying, 3000);
  EXPECT_EQ(found, lying);
}

TEST(SampleLandings, EndsWhereFilmIsTorn) {
  DippedFilm film = fixtures::film_on_slab(5000);
  const auto beyond_mm = [](const Vec2& u) { return u.x() + 0.4 * u.y() - 3.21; };
  for (const Vec2& u : film.mesh().u) film.excess.push_back(0.01 * beyond_mm(u));
  const auto dipped = fixtures::mapped(fixtures::slab(), std::move(film));
  const SampleGrid grid = whole_sheet(211);
  const SampleLandings landings(*dipped->map, grid, dipped->map->lying());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 u = grid.at(column, row);
      if (u.cwiseAbs().maxCoeff() > fixtures::kHalfSide_mm) continue;
      EXPECT_EQ(landings.pair_at(column, row) != SampleLandings::kNone, beyond_mm(u) <= 0)
          << u.transpose();
    }
}

// What a pixel's samples land on is told from one of them on.
TEST(SampleLandings, ALandingsGridIsTheSamplesOfItsPair) {
  const auto dipped = dipped_sphere();
  const SampleGrid grid = whole_sheet(303);
  const SampleLandings landings(*dipped->map, grid, dipped->map->lying());
  int compared = 0;
  for (int row = 0; row < grid.rows; row += 3)
    for (int column = 0; column < grid.columns; column += 3) {
      const std::int32_t pair = landings.pair_at(column, row);
      if (pair == SampleLandings::kNone) continue;
      const SurfaceGrid pixel = landings.landing(pair, column, row, 3);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          if (landings.pair_at(column + i, row + j) != pair) continue;
          ++compared;
          EXPECT_LT((position_at(dipped->object, pixel.at(i, j)) -
                     position_at(dipped->object, landing(landings, column + i, row + j)))
                        .norm(),
                    2e-4);
        }
    }
  EXPECT_GT(compared, 5000);
}

}  // namespace
}  // namespace hydrodip
