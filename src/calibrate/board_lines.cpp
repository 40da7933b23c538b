#include "calibrate/board_lines.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

// As far from the centre as the kit's shapes take up film, with some to spare.
constexpr double kTakenUp_mm = 60;
// Lines this near are one.
constexpr double kSame_mm = 1e-6;
constexpr int kMostCells = 64;

// Whether film is softer in some square of a line of squares than in its neighbour there.
bool is_softer(const Board& board, int line, int neighbour, bool columns) {
  for (int i = 0; i < board.period; ++i) {
    const GridPlace here = columns ? GridPlace{line, i} : GridPlace{i, line};
    const GridPlace there = columns ? GridPlace{neighbour, i} : GridPlace{i, neighbour};
    if (board.ink_of(here) < board.ink_of(there)) return true;
  }
  return false;
}

BoardGrid coarser(const BoardGrid& grid) {
  return {std::max(1, grid.cells / 3), std::max(1, grid.ramp_cells / 2)};
}

// Of one line of squares, at distances from its lower edge, the upper one left out.
std::vector<double> lines_in_square(double square_mm, double low_ramp, double high_ramp,
                                    const BoardGrid& grid) {
  std::vector<double> lines;
  const auto divide = [&](double from, double to, int count) {
    if (to - from < kSame_mm) return;
    for (int i = 0; i < count; ++i) lines.push_back(from + (to - from) * i / count);
  };
  divide(0, low_ramp, grid.ramp_cells);
  divide(low_ramp, square_mm - high_ramp, grid.cells);
  divide(square_mm - high_ramp, square_mm, grid.ramp_cells);
  return lines;
}

// From the centre to the rim and not farther.
std::vector<double> lines_outwards(double half, const Board& board, double filter_mm,
                                   const BoardGrid& grid, bool columns) {
  const double square = board.square_mm, reach = 0.5 * filter_mm;
  std::vector<double> lines = {0};
  for (int line = 0;; ++line) {
    const Vec2 edge = board.on_film({line, line});
    const double low = columns ? edge.x() : edge.y();
    if (low >= half) break;
    // What is true of a line of squares shall be true of its mirror image.
    const int mirrored = board.about_square ? -line : -1 - line;
    const bool at_low = is_softer(board, line, line - 1, columns) ||
                        is_softer(board, mirrored, mirrored + 1, columns);
    const bool at_high = is_softer(board, line, line + 1, columns) ||
                         is_softer(board, mirrored, mirrored - 1, columns);
    const double ramp = 2 * reach < square ? reach : 0;
    const bool taken_up = low + 0.5 * square < kTakenUp_mm;
    const BoardGrid here = taken_up ? grid : coarser(grid);
    for (const double x : lines_in_square(square, at_low ? ramp : 0, at_high ? ramp : 0, here))
      if (low + x > lines.back() + kSame_mm && low + x < half - kSame_mm) lines.push_back(low + x);
  }
  lines.push_back(half);
  return lines;
}

std::vector<double> halved(const std::vector<double>& lines) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    result.push_back(lines[i]);
    result.push_back(0.5 * (lines[i] + lines[i + 1]));
  }
  result.push_back(lines.back());
  return result;
}

std::vector<double> mirrored(const std::vector<double>& outwards) {
  std::vector<double> lines;
  for (std::size_t i = outwards.size() - 1; i > 0; --i) lines.push_back(-outwards[i]);
  lines.insert(lines.end(), outwards.begin(), outwards.end());
  return lines;
}

std::size_t triangles_on(const GridLines& lines) {
  return 2 * (lines.x.size() - 1) * (lines.y.size() - 1);
}

}  // namespace

GridLines board_lines(const FilmOptions& film, const Board& board, double filter_mm,
                      const BoardGrid& grid) {
  const Vec2 half = half_of_free_film(film);
  GridLines lines;
  for (const bool columns : {true, false}) {
    std::vector<double> outwards =
        lines_outwards(columns ? half.x() : half.y(), board, filter_mm, grid, columns);
    for (int i = 0; i < grid.halvings; ++i) outwards = halved(outwards);
    (columns ? lines.x : lines.y) = mirrored(outwards);
  }
  return lines;
}

BoardGrid board_grid(const FilmOptions& film, const Board& board, double filter_mm) {
  BoardGrid best;
  double least = 0;
  for (int cells = 1; cells <= kMostCells; ++cells) {
    const BoardGrid grid = {cells, 1 + (cells - 1) / 4, 0};
    const double off = std::abs(
        std::log(double(triangles_on(board_lines(film, board, filter_mm, grid))) / film.elements));
    if (cells > 1 && off >= least) break;
    best = grid;
    least = off;
  }
  return best;
}

}  // namespace hydrodip
