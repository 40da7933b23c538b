#include "calibrate/board_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibrate/checkerboard_dip.h"
#include "scans.h"

namespace hydrodip {
namespace {

constexpr double kFilter_mm = 1.016;

FilmOptions letter() { return {.width_mm = 215.9, .height_mm = 279.4, .margin_mm = 10}; }

bool has(const std::vector<double>& lines, double x) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](double line) { return std::abs(line - x) < 1e-9; });
}

class BoardLinesTest : public testing::TestWithParam<const char*> {
 protected:
  Board board() const { return board_named(GetParam(), 0); }
};

TEST_P(BoardLinesTest, EveryEdgeOfASquareIsALine) {
  for (const int cells : {1, 3}) {
    const GridLines lines = board_lines(letter(), board(), kFilter_mm, {cells, 1, 0});
    for (int place = -18; place <= 18; ++place) {
      EXPECT_TRUE(has(lines.x, board().on_film({place, 0}).x())) << place;
      EXPECT_TRUE(has(lines.y, board().on_film({0, place}).y())) << place;
    }
  }
}

TEST_P(BoardLinesTest, MirroredLinesAreLinesFromRimToRim) {
  const GridLines lines = board_lines(letter(), board(), kFilter_mm, {2, 2, 1});
  for (const auto* axis : {&lines.x, &lines.y}) {
    ASSERT_EQ(axis->size() % 2, 1u);
    for (std::size_t i = 0; i < axis->size(); ++i)
      EXPECT_EQ((*axis)[i], -(*axis)[axis->size() - 1 - i]);
    EXPECT_TRUE(std::is_sorted(axis->begin(), axis->end(), std::less_equal<>()));
  }
  EXPECT_DOUBLE_EQ(lines.x.back(), 215.9 / 2 - 10);
  EXPECT_DOUBLE_EQ(lines.y.back(), 279.4 / 2 - 10);
}

TEST_P(BoardLinesTest, HalvingPutsOneLineIntoEveryCell) {
  const GridLines lines = board_lines(letter(), board(), kFilter_mm, {2, 1, 0});
  const GridLines finer = board_lines(letter(), board(), kFilter_mm, {2, 1, 1});
  ASSERT_EQ(finer.x.size(), 2 * lines.x.size() - 1);
  for (std::size_t i = 0; i + 1 < lines.x.size(); ++i) {
    EXPECT_NEAR(finer.x[2 * i], lines.x[i], 1e-12);
    EXPECT_NEAR(finer.x[2 * i + 1], 0.5 * (lines.x[i] + lines.x[i + 1]), 1e-12);
  }
}

TEST_P(BoardLinesTest, TrianglesAreAboutAsManyAsAskedFor) {
  FilmOptions film = letter();
  for (const int elements : {40000, 160000, 640000}) {
    film.elements = elements;
    const GridLines lines =
        board_lines(film, board(), kFilter_mm, board_grid(film, board(), kFilter_mm));
    const double count = 2.0 * double(lines.x.size() - 1) * double(lines.y.size() - 1);
    EXPECT_LT(std::abs(std::log(count / elements)), std::log(1.4)) << elements;
  }
}

// Beyond the filter's reach a triangle has its square's own ink and no other, and what is smeared
// over an edge is smeared into no triangle that reaches farther.
TEST_P(BoardLinesTest, TrianglesBeyondTheFiltersReachHaveTheirSquaresInk) {
  DesignOptions design;
  design.film.elements = 40000;
  const CheckeredFilm film = checkered_film(design, board());
  const double reach = 0.5 * design.stiffness.filter_mm;
  std::size_t even = 0;
  for (std::size_t t = 0; t < film.mesh->triangles.size(); ++t) {
    const Triangle& v = film.mesh->triangles[t];
    Vec2 low = film.mesh->u[std::size_t(v[0])], high = low;
    for (const std::int32_t k : v) {
      low = low.cwiseMin(film.mesh->u[std::size_t(k)]);
      high = high.cwiseMax(film.mesh->u[std::size_t(k)]);
    }
    const Vec2 nudge = Vec2::Constant(1e-6);
    const GridPlace square = board().square_at(low + nudge);
    EXPECT_EQ(square, board().square_at(high - nudge)) << "across an edge";
    const Vec2 from = board().on_film(square), to = board().on_film({square[0] + 1, square[1] + 1});
    const bool inside =
        ((low - from).array() > reach - 1e-6).all() && ((to - high).array() > reach - 1e-6).all();
    const Vec2 rim = half_of_free_film(design.film) - Vec2::Constant(board().square_mm);
    if (!inside || (low.cwiseAbs().array() > rim.array()).any()) continue;
    ++even;
    EXPECT_NEAR(film.ink_density[t], board().ink_of(square) / 255.0, 1e-6);
  }
  EXPECT_GT(even, film.mesh->triangles.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(Boards, BoardLinesTest, testing::Values("tints", "black"));

// Only where the neighbour has more ink is there a line beside the edge.
TEST(BoardLinesTest, SmearedInkHasLinesInTheSofterSquareOnly) {
  const GridLines lines = board_lines(letter(), tint_board(5), kFilter_mm, {1, 1, 0});
  for (const double edge : {12.5, 32.5, 72.5}) {  // dark squares' columns end, softer ones begin
    EXPECT_TRUE(has(lines.x, edge + kFilter_mm / 2)) << edge;
    EXPECT_FALSE(has(lines.x, edge - kFilter_mm / 2)) << edge;
  }
}

}  // namespace
}  // namespace hydrodip
