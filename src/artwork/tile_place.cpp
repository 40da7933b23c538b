#include "artwork/tile_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artwork/picture.h"
#include "base/filled.h"
#include "base/parallel.h"
#include "image/resize.h"

namespace hydrodip {
namespace {

// The tile is looked at in so many cells along each side.
constexpr int kCells = 40;
// A seam is worse than any detail.
constexpr double kSeam = 3;

using Cells = std::vector<double>;

int wrapped(int i) { return (i % kCells + kCells) % kCells; }
std::size_t cell(int x, int y) {
  return std::size_t(wrapped(y)) * kCells + std::size_t(wrapped(x));
}

double lightness(const std::uint8_t* pixel) {
  return pixel[3] / 255.0 * (0.3 * pixel[0] + 0.6 * pixel[1] + 0.1 * pixel[2]) / 255.0 +
         (1 - pixel[3] / 255.0);
}

// How much happens in each cell; 1 on average.
Cells detail_of(const Image& tile) {
  constexpr int kFine = 4;
  constexpr int kSide = kCells * kFine;
  const Image small = resize(tile, std::min(tile.width_px, kSide), std::min(tile.height_px, kSide));
  Cells detail = filled(std::size_t(kCells) * kCells, 0.0);
  double total = 0;
  for (int y = 0; y < small.height_px; ++y)
    for (int x = 0; x < small.width_px; ++x) {
      const double here = lightness(small.pixel(x, y));
      const double right = lightness(small.pixel((x + 1) % small.width_px, y));
      const double below = lightness(small.pixel(x, (y + 1) % small.height_px));
      const double change = std::abs(right - here) + std::abs(below - here);
      detail[cell(x * kCells / small.width_px, y * kCells / small.height_px)] += change;
      total += change;
    }
  const double mean = std::max(total / double(detail.size()), 1e-9);
  for (double& value : detail) value /= mean;
  if (is_seamless(tile)) return detail;
  for (int i = 0; i < kCells; ++i)
    for (const std::size_t at : {cell(i, 0), cell(0, i), cell(i, -1), cell(-1, i)})
      detail[at] = std::max(detail[at], kSeam) + kSeam;
  return detail;
}

Cells weights_by_cell(const PictureFrame& frame, const std::vector<FilmPiece>& pieces) {
  Cells weights = filled(std::size_t(kCells) * kCells, 0.0);
  for (const FilmPiece& piece : pieces) {
    const Vec2 t = kCells * frame.to_picture(piece.film_mm);
    weights[cell(int(std::floor(t.x())), int(std::floor(t.y())))] += piece.weight;
  }
  return weights;
}

}  // namespace

bool is_seamless(const Image& tile) {
  // Across its edges a tile may change as much as it does nearby.
  const int width = tile.width_px, height = tile.height_px;
  if (width < 4 || height < 4) return true;
  double across = 0, beside = 0;
  const auto change = [&](int x0, int y0, int x1, int y1) {
    return std::abs(lightness(tile.pixel(x0, y0)) - lightness(tile.pixel(x1, y1)));
  };
  for (int y = 0; y < height; ++y) {
    across += change(width - 1, y, 0, y);
    beside += 0.5 * (change(0, y, 1, y) + change(width - 2, y, width - 1, y));
  }
  for (int x = 0; x < width; ++x) {
    across += change(x, height - 1, x, 0);
    beside += 0.5 * (change(x, 0, x, 1) + change(x, height - 2, x, height - 1));
  }
  constexpr double kMore = 2.5, kVisible = 0.02;
  return across <= kMore * beside + kVisible * (width + height);
}

TilePlace best_tile_place(const Image& tile, const Vec2& size_mm,
                          const std::vector<FilmPiece>& pieces,
                          const std::vector<double>& turns_deg) {
  const Cells detail = detail_of(tile);
  std::vector<TilePlace> best(turns_deg.size());
  double total_weight = 0, total_detail = 0;
  for (const FilmPiece& piece : pieces) total_weight += piece.weight;
  for (const double value : detail) total_detail += value;
  const double mean = std::max(total_weight * total_detail / double(detail.size()), 1e-12);
  parallel_for(turns_deg.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Cells weights =
          weights_by_cell(PictureFrame(size_mm, turns_deg[n], Repeat::kTile), pieces);
      best[n].trouble = 1e300;
      for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
          double trouble = 0;
          for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x)
              trouble += weights[cell(x, y)] * detail[cell(x - i, y - j)];
          trouble /= mean;
          if (trouble >= best[n].trouble * (1 - 1e-9)) continue;
          // The tile moves by so many of its own cells to the right and down.
          const double turn = turns_deg[n] * std::numbers::pi / 180;
          const Vec2 own(size_mm.x() * i / kCells, -size_mm.y() * j / kCells);
          best[n] = {{std::cos(turn) * own.x() - std::sin(turn) * own.y(),
                      std::sin(turn) * own.x() + std::cos(turn) * own.y()},
                     turns_deg[n],
                     trouble};
        }
    }
  });
  TilePlace found;
  found.trouble = 1e300;
  for (const TilePlace& place : best)
    if (place.trouble < found.trouble * (1 - 1e-9)) found = place;
  if (!(found.trouble < 1e300)) return {};
  return found;
}

}  // namespace hydrodip
