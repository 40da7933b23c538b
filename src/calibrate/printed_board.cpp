#include "calibrate/printed_board.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace hydrodip {
namespace {

// Finer than the stiffness filter by far; squares are whole pixels.
constexpr double kPixel_mm = 0.1;
constexpr std::size_t kRowGrain = 32;  // rows

}  // namespace

PrintedBoard print_board(const FilmOptions& film, const Board& board) {
  // An even number of pixels, so that half a square is whole pixels as well.
  const double pixels = std::max(4.0, 2 * std::round(0.5 * board.square_mm / kPixel_mm));
  PrintedBoard printed;
  printed.raster = {film.width_mm, film.height_mm, pixels * kMmPerInch / board.square_mm};
  printed.inks = InkImage(printed.raster.width_px(), printed.raster.height_px());
  const Vec2 edge(0.5 * film.width_mm - film.margin_mm, 0.5 * film.height_mm - film.margin_mm);
  const auto print_row = [&](int y) {
    for (int x = 0; x < printed.inks.width_px; ++x) {
      const Vec2 u = printed.raster.to_film(x + 0.5, y + 0.5);
      if (std::abs(u.x()) > edge.x() || std::abs(u.y()) > edge.y()) continue;
      printed.inks.pixel(x, y)[3] = board.ink_of(board.square_at(u));
    }
  };
  parallel_for(std::size_t(printed.inks.height_px), kRowGrain,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t y = begin; y < end; ++y) print_row(int(y));
               });
  return printed;
}

}  // namespace hydrodip
