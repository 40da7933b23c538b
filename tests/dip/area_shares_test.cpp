// What a triangle counts at its corners: half of an obtuse one at the obtuse corner. Triangles like
// that lie along the rim of a disc.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "dip/measure.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

// Two triangles on one side of an axis each, the right one drawn out to twice its area, the left
// one as it was: the vertices on the axis have the mean by their shares.
struct Pair {
  FilmMesh film;
  DipState state;
  // apex: of the triangle right of the axis, its base from (0, -1) to (0, 1); mirrored on the left
  // at `other`.
  Pair(const Vec2& apex, const Vec2& other) {
    film.u = {Vec2(0, -1), Vec2(0, 1), apex, other};
    film.triangles = {{0, 2, 1}, {0, 1, 3}};
    film.on_rim = {1, 1, 1, 1};
    film.cell_mm = 2;
    for (const Vec2& u : film.u)
      state.position.emplace_back(u.x() > 0 ? 2 * u.x() : u.x(), u.y(), 0);
    state.state.assign(4, VertexState::kAttached);
    state.torn.assign(2, 0);
    state.torn_at_mm.assign(2, 1e300);
  }
  std::vector<double> area_ratio() const {
    const shapes::Shape slab = shapes::box(Vec3(-99, -99, 0), Vec3(99, 99, 5));
    const Surface surface(slab.positions, slab.triangles);
    DipOptions options;
    options.material.tear_stretch = 0;
    return measured(std::make_shared<const FilmMesh>(film), state, options, surface).area_ratio;
  }
};

double mean(double right_share, double left_share) {
  return (2 * right_share + 1 * left_share) / (right_share + left_share);
}

TEST(AreaShares, OfRightAnglesAreExact) {
  // Apexes at (+-1, 0): right angles there, 45 degrees on the axis; area 1. At a right angle the
  // Voronoi cell is half of the triangle, at the others a quarter.
  const auto ratio = Pair(Vec2(1, 0), Vec2(-1, 0)).area_ratio();
  EXPECT_NEAR(ratio[0], 1.5, 1e-12);
  EXPECT_NEAR(ratio[2], 2, 1e-12);
  EXPECT_NEAR(ratio[3], 1, 1e-12);
}

TEST(AreaShares, OfAnObtuseTriangleAreAQuarterAndAHalf) {
  // Left: obtuse at its apex, area 0.2; right: a right angle there, area 1.
  const auto ratio = Pair(Vec2(1, 0), Vec2(-0.2, 0)).area_ratio();
  EXPECT_NEAR(ratio[0], mean(1.0 / 4, 0.2 / 4), 1e-12);
  EXPECT_NEAR(ratio[1], mean(1.0 / 4, 0.2 / 4), 1e-12);
  // Left: obtuse at (0, -1), area 1.
  const auto leaning = Pair(Vec2(1, 0), Vec2(-1, -3)).area_ratio();
  EXPECT_NEAR(leaning[0], mean(1.0 / 4, 1.0 / 2), 1e-12);
  EXPECT_NEAR(leaning[1], mean(1.0 / 4, 1.0 / 4), 1e-12);
}

// An equilateral triangle is shared in three; all shares are positive and sum up.
TEST(AreaShares, OfAnEquilateralTriangleAreThirds) {
  const double height = std::sqrt(3.0);
  const auto ratio = Pair(Vec2(1, 0), Vec2(-height, 0)).area_ratio();
  EXPECT_NEAR(ratio[0], mean(1.0 / 4, height / 3), 1e-12);
}

}  // namespace
}  // namespace hydrodip
