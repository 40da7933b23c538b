#include "calibrate/board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hydrodip {
namespace {

// Finer than the stiffness filter by far; squares are whole pixels.
constexpr double kPixel_mm = 0.1;

int modulo(int a, int period) { return (a % period + period) % period; }

}  // namespace

std::uint8_t Board::ink_of(const GridPlace& square) const {
  return ink[std::size_t(modulo(square[1], period) * period + modulo(square[0], period))];
}

Vec2 Board::on_film(const GridPlace& corner) const {
  const double shift = about_square ? -0.5 : 0;
  return square_mm * Vec2(corner[0] + shift, corner[1] + shift);
}

GridPlace Board::square_at(const Vec2& u) const {
  const double shift = about_square ? 0.5 : 0;
  return {int(std::floor(u.x() / square_mm + shift)), int(std::floor(u.y() / square_mm + shift))};
}

Board black_board(double square_mm) { return {"black", square_mm, false, 2, {255, 0, 0, 255}}; }

Board tint_board(double square_mm) {
  // The best of those that bench_board tries: 1.2 % of ink beside dark squares, none between.
  return {"tints", square_mm, true, 2, {255, 3, 3, 0}};
}

Board board_named(const std::string& name, double square_mm) {
  if (name == "tints") return tint_board(square_mm > 0 ? square_mm : kTintSquare_mm);
  if (name == "black") return black_board(square_mm > 0 ? square_mm : kBlackSquare_mm);
  throw InputError(fmt::format("--board '{}': give tints (what the kit prints) or black", name));
}

PrintedBoard print_board(const FilmOptions& film, const Board& board) {
  // An even number of pixels, so that half a square is whole pixels as well.
  const double pixels = std::max(4.0, 2 * std::round(0.5 * board.square_mm / kPixel_mm));
  PrintedBoard printed;
  printed.raster = {film.width_mm, film.height_mm, pixels * kMmPerInch / board.square_mm};
  printed.inks = InkImage(printed.raster.width_px(), printed.raster.height_px());
  const Vec2 edge(0.5 * film.width_mm - film.margin_mm, 0.5 * film.height_mm - film.margin_mm);
  for (int y = 0; y < printed.inks.height_px; ++y)
    for (int x = 0; x < printed.inks.width_px; ++x) {
      const Vec2 u = printed.raster.to_film(x + 0.5, y + 0.5);
      if (std::abs(u.x()) > edge.x() || std::abs(u.y()) > edge.y()) continue;
      printed.inks.pixel(x, y)[3] = board.ink_of(board.square_at(u));
    }
  return printed;
}

}  // namespace hydrodip
