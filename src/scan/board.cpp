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
  // One of the good ones in docs/calibration.md: along a row, two of three
  // gaps between dark squares have 1.6 % of ink and one has none, so that it takes more of the
  // stretch, the more the stiffer ink is. Where all gaps are alike, they share the stretch alike,
  // whatever the ratio.
  constexpr std::uint8_t d = 255, f = 4, o = 0;
  return {"tints", square_mm, true, 6, {d, f, d, o, d, f,  //
                                        f, f, f, o, f, f,  //
                                        d, f, d, o, d, f,  //
                                        o, o, o, o, o, o,  //
                                        d, f, d, o, d, f,  //
                                        f, f, f, o, f, f}};
}

Board board_named(const std::string& name, double square_mm) {
  if (name.empty() || name == "tints")
    return tint_board(square_mm > 0 ? square_mm : kTintSquare_mm);
  if (name == "black") return black_board(square_mm > 0 ? square_mm : kBlackSquare_mm);
  throw InputError(fmt::format("--board '{}': give tints (what the kit prints) or black", name));
}

}  // namespace hydrodip
