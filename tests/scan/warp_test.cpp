// From corners on a scanned object back to the film, and what a shrunk grid counts.
#include <gtest/gtest.h>

#include <cmath>

#include "scan/grid_error.h"
#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

constexpr double kSquare_mm = 5;

// Corners 5 mm apart on the slab's bottom, `off_mm` below it.
CornerGrid corners_below(double off_mm, int columns = 5, int rows = 4) {
  CornerGrid grid;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      grid.position.push_back(Vec3(kSquare_mm * i - 10, kSquare_mm * j - 8, -off_mm));
      grid.place.push_back({i, j});
      grid.patch.push_back(0);
    }
  return grid;
}

// Film that lies there as it was printed: corners come from where they are seen.
TEST(Warp, FindsTheFilmUnderACorner) {
  const auto slab = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(2000));
  const CornerGrid grid = corners_below(0.3);
  const WarpedGrid warped = warp(grid, *slab->surface, *slab->map, 0.5);
  ASSERT_EQ(warped.size(), grid.position.size());
  for (std::size_t c = 0; c < warped.size(); ++c) {
    ASSERT_TRUE(warped[c]);
    EXPECT_LT((*warped[c] - grid.position[c].head<2>()).norm(), 1e-6);
  }
}

TEST(Warp, HasNothingBeyondItsReachOrWithoutFilm) {
  const auto slab = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(2000));
  for (const auto& corner : warp(corners_below(0.6), *slab->surface, *slab->map, 0.5))
    EXPECT_FALSE(corner);
  CornerGrid above = corners_below(0);
  for (Vec3& corner : above.position) corner.z() = 8.1;  // the slab's bare top
  for (const auto& corner : warp(above, *slab->surface, *slab->map, 0.5)) EXPECT_FALSE(corner);
}

// Shorter than printed is as wrong as longer.
TEST(GridErrorOfAShrunkGrid, IsPositive) {
  const CornerGrid grid = corners_below(0);
  WarpedGrid warped;
  for (const GridPlace& place : grid.place)
    warped.push_back(Vec2(0.98 * kSquare_mm * Vec2(place[0], place[1])));
  const auto errors = length_errors(grid_lengths(grid), warped, kSquare_mm);
  for (const LengthError& error : errors) EXPECT_LT(error.error_mm, 0);
  const GridError error = grid_error(errors, kSquare_mm);
  const double edge = 0.02 * kSquare_mm, diagonal = std::sqrt(2.0) * edge;
  EXPECT_NEAR(error.worst_mm, diagonal, 1e-12);
  EXPECT_NEAR(error.mean_mm,
              (error.edges * edge + error.diagonals * diagonal) / (error.edges + error.diagonals),
              1e-12);
  EXPECT_NEAR(error.edge_rms_mm, edge, 1e-12);
}

}  // namespace
}  // namespace hydrodip
