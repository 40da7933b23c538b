#include "scan/board.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"

namespace hydrodip {
namespace {

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

}  // namespace hydrodip
