#include "scan/grid_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

constexpr double kSquare_mm = 5;

CornerGrid board(int columns, int rows) {
  CornerGrid grid;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      grid.position.push_back(Vec3::Zero());
      grid.place.push_back({i, j});
      grid.patch.push_back(0);
    }
  return grid;
}

// The grid on the film after a linear map and a shift.
WarpedGrid mapped(const CornerGrid& grid, const Mat2& map, const Vec2& shift = Vec2::Zero()) {
  WarpedGrid warped;
  for (const GridPlace& place : grid.place)
    warped.push_back(Vec2(map * (kSquare_mm * Vec2(place[0], place[1])) + shift));
  return warped;
}

GridError error_of(const CornerGrid& grid, const WarpedGrid& warped) {
  return grid_error(length_errors(grid_lengths(grid), warped, kSquare_mm), kSquare_mm);
}

TEST(GridErrorTest, TurnsAndShiftsOfTheFilmDoNotCount) {
  const CornerGrid grid = board(6, 4);
  const double angle = 0.7;
  const Mat2 turn =
      (Mat2() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)).finished();
  const GridError error = error_of(grid, mapped(grid, turn, {12, -3}));
  EXPECT_NEAR(error.rms_mm, 0, 1e-12);
  EXPECT_NEAR(error.literal, 0, 1e-12);
  EXPECT_EQ(error.edges, 5 * 4 + 6 * 3);
  EXPECT_EQ(error.diagonals, 2 * 5 * 3);
}

TEST(GridErrorTest, AnEvenlyStretchedGridHasItsExactValue) {
  const CornerGrid grid = board(5, 5);
  const double strain = 0.02;
  const GridError error = error_of(grid, mapped(grid, (1 + strain) * Mat2::Identity()));
  const double edges = 40, diagonals = 32;
  const double edge = strain * kSquare_mm, diagonal = std::sqrt(2.0) * edge;
  const double sum = edges * edge * edge + diagonals * diagonal * diagonal;
  EXPECT_NEAR(error.edge_rms_mm, edge, 1e-12);
  EXPECT_NEAR(error.diagonal_rms_mm, diagonal, 1e-12);
  EXPECT_NEAR(error.rms_mm, std::sqrt(sum / (edges + diagonals)), 1e-12);
  EXPECT_NEAR(error.worst_mm, diagonal, 1e-12);
  EXPECT_NEAR(error.mean_mm, (edges * edge + diagonals * diagonal) / (edges + diagonals), 1e-12);
  // Eq. 4 as printed: over the sum of the warped lengths.
  const double lengths = (1 + strain) * kSquare_mm * (edges + std::sqrt(2.0) * diagonals);
  EXPECT_NEAR(error.literal, std::sqrt(sum / lengths), 1e-12);
}

TEST(GridErrorTest, DiagonalsSeeAShear) {
  const CornerGrid grid = board(4, 4);
  Mat2 shear = Mat2::Identity();
  shear(0, 1) = 0.05;
  const GridError error = error_of(grid, mapped(grid, shear));
  EXPECT_GT(error.diagonal_rms_mm, 5 * error.edge_rms_mm);
}

TEST(GridErrorTest, CornersWithoutFilmTakeTheirLengthsWithThem) {
  const CornerGrid grid = board(3, 3);
  WarpedGrid warped = mapped(grid, Mat2::Identity());
  warped[4].reset();  // the middle one: four edges and four diagonals
  const GridError error = error_of(grid, warped);
  EXPECT_EQ(error.edges, 12 - 4);
  EXPECT_EQ(error.diagonals, 8 - 4);
}

}  // namespace
}  // namespace hydrodip
