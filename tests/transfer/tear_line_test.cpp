// Film that is torn along a line inside its triangles: whole on one side of it, torn on the other,
// for all who ask, and its area exactly so.
#include <gtest/gtest.h>

#include <limits>

#include "transfer/coverage.h"
#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

constexpr double kLine_mm = 3.21, kSlope = 0.4;

double beyond(const Vec2& u) { return u.x() + kSlope * u.y() - kLine_mm; }

// On the slab's bottom, stretched by 1.4 at the line, by 0.01 more for each millimetre beyond it.
std::unique_ptr<fixtures::Dipped> torn_along_a_line() {
  DippedFilm film = fixtures::film_on_slab(5000);
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    film.excess.push_back(0.01 * beyond(film.mesh().u[v]));
    film.stretch[v] = 1.4 + film.excess.back();
  }
  film.torn_at_mm.assign(film.torn.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < film.torn.size(); ++t) {
    const Triangle& v = film.mesh().triangles[t];
    film.torn[t] = film.lies_on_object(t) && film.excess_of(v[0]) > 0 && film.excess_of(v[1]) > 0 &&
                   film.excess_of(v[2]) > 0;
  }
  return fixtures::mapped(fixtures::slab(), std::move(film));
}

TEST(TearLine, PartsWholeFilmFromTornInBothDirections) {
  const auto dipped = torn_along_a_line();
  const FilmMap& map = *dipped->map;
  for (double x = -19.93; x < 20; x += 0.77)
    for (double y = -19.97; y < 20; y += 0.91) {
      const Vec2 u(x, y);
      const Vec3 position(x, y, 0), down(0, 0, -1);
      const bool whole = beyond(u) < 0;
      EXPECT_EQ(map.to_object(u).has_value(), whole) << x << " " << y;
      EXPECT_EQ(map.to_film(position, down).has_value(), whole) << x << " " << y;
      EXPECT_EQ(map.torn_at(position, down), !whole) << x << " " << y;
      const auto hold = map.hold_at(position, down);
      ASSERT_TRUE(hold);
      EXPECT_EQ(hold->whole, whole);
      EXPECT_FALSE(hold->let_go);
      EXPECT_NEAR(hold->stretch, 1.4 + 0.01 * beyond(u), 1e-9);
      const auto near = map.nearest_covered(u, 50);
      ASSERT_TRUE(near);
      EXPECT_TRUE(map.to_object(*near));
      const double from_line = beyond(u) / std::hypot(1, kSlope);
      if (whole) {
        EXPECT_EQ(*near, u);
      } else if ((u - from_line * Vec2(1, kSlope).normalized()).cwiseAbs().maxCoeff() < 19.9) {
        EXPECT_NEAR((*near - u).norm(), from_line, 1e-4);
      }
    }
}

TEST(TearLine, AreasAreThoseOfTheCutSquare) {
  const auto dipped = torn_along_a_line();
  const auto& film = dipped->film;
  // The line leaves the square through its sides y = +-20; film beyond by 5 is stretched by 1.45.
  const double covered = 40 * (20 + kLine_mm);
  const Coverage all =
      measure_coverage(dipped->object, *dipped->surface, film, straight_down_to(3), {1.35, 1.45});
  EXPECT_NEAR(all.covered_mm2, covered, 1e-6);
  EXPECT_NEAR(all.film_on_object_mm2, covered, 1e-6);
  EXPECT_NEAR(all.torn_mm2, 1600 - covered, 1e-6);
  EXPECT_NEAR(all.doubtful_mm2, 40 * 10, 1e-6);
  const Coverage never =
      measure_coverage(dipped->object, *dipped->surface, film, straight_down_to(3));
  EXPECT_EQ(never.doubtful_mm2, 0);
}

// Walls that stand upright but for rounding face nowhere.
TEST(Coverage, UprightWallsDoNotFaceDown) {
  for (const double noise : {-1e-9, -1e-12, 0.0, 1e-12, 1e-9}) {
    Object leaning = fixtures::slab();
    for (Vec3& p : leaning.positions) p += noise * p.z() * Vec3(1, -1, 0);
    const auto dipped = fixtures::mapped(leaning, fixtures::film_on_slab(5000));
    const Coverage c =
        measure_coverage(dipped->object, *dipped->surface, dipped->film, straight_down_to(9));
    EXPECT_NEAR(c.downward_mm2, 1600, 1e-3) << noise;
    EXPECT_NEAR(c.object_mm2, 3200 + 160 * dipped->object.bounds().size().z(), 1e-3) << noise;
  }
}

// However little it is stretched.
TEST(TearLine, FilmWhosePlaceIsNotKnownIsDoubtful) {
  DippedFilm film = fixtures::film_on_slab(5000);
  film.torn_at_mm.assign(film.torn.size(), std::numeric_limits<double>::infinity());
  for (const Vec2& u : film.mesh().u) film.moved_mm.push_back(kMoved_mm + 0.01 * beyond(u));
  const auto dipped = fixtures::mapped(fixtures::slab(), std::move(film));
  const Coverage c = measure_coverage(dipped->object, *dipped->surface, dipped->film,
                                      straight_down_to(3), {1.3, 1.6});
  EXPECT_NEAR(c.doubtful_mm2, 1600 - 40 * (20 + kLine_mm), 1e-6);
}

TEST(TearLine, DoubtGrowsFromSafeToLost) {
  const DoubtfulStretch doubtful{1.3, 1.6};
  EXPECT_EQ(doubtful.of(1.2, 0), 0);
  EXPECT_NEAR(doubtful.of(1.45, 0), 0.5, 1e-12);
  EXPECT_EQ(doubtful.of(1.7, 0), 1);
  EXPECT_NEAR(doubtful.of(1, kMoved_mm), 0.5, 1e-12);
  EXPECT_EQ(doubtful.of(1, 3), 1);
  EXPECT_EQ(DoubtfulStretch().of(9, 9), 0);
}

}  // namespace
}  // namespace hydrodip
