// The board of inked squares whose corners are looked for on the dipped object.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"
#include "scan/corner_grid.h"

namespace hydrodip {

// Squares side by side over the whole free film, each inked evenly. Which ink repeats with a period
// of squares along both axes. A value.
struct Board {
  std::string name;  // what files and options call it
  double square_mm = 5;
  // The film's centre is the middle of the square {0, 0}; else its lowest corner.
  bool about_square = false;
  int period = 1;
  std::vector<std::uint8_t> ink;  // of the square {column, row}: [row % period * period + column %
                                  // period], 255: a full pass

  // Of a square; a square's place is that of its corner with the least coordinates.
  std::uint8_t ink_of(const GridPlace& square) const;
  // Where a corner is printed, mm on the film. Corners' places are counted so that {0, 0} is the
  // centre, or the corner next to it towards -x and -y.
  Vec2 on_film(const GridPlace& corner) const;
  // The square in which a point of the film lies.
  GridPlace square_at(const Vec2& u) const;
};

// Of the boards' squares, if nothing else is said.
constexpr double kTintSquare_mm = 5, kBlackSquare_mm = 5;

// Black and blank squares in turn, one corner at the film's centre: what the paper dips. It tells
// hard ink from very hard ink badly (docs/calibration.md).
Board black_board(double square_mm);

// Dark squares, each alone, one in four, so that every corner is a dark square's corner and easily
// seen; between them faint ones, whose inks were chosen so that the ratio shows from 3 to 3000.
// Looks the same after a quarter turn and in a mirror: a scan cannot be read the wrong way round.
Board tint_board(double square_mm);

// "tints" (also if empty) or "black"; squares of 0 mm: its own. Throws InputError.
Board board_named(const std::string& name, double square_mm);

}  // namespace hydrodip
