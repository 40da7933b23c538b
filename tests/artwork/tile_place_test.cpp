#include "artwork/tile_place.h"

#include <gtest/gtest.h>

#include "artwork/picture.h"
#include "shapes.h"

namespace hydrodip {
namespace {

// Quiet on its left half, chequered on its right; goes on across its edges.
std::shared_ptr<const Image> half_busy() {
  return painted(160, 160, [](int x, int y) {
    const int grey = x < 80 || (x / 8 + y / 8) % 2 == 0 ? 200 : 40;
    return std::array{grey, grey, grey, 255};
  });
}

TEST(TilePlace, KeepsDetailAwayFromWhereItDisturbs) {
  const Vec2 size(40, 40);
  std::vector<FilmPiece> pieces;
  for (double x = -8; x <= 8; x += 1)
    for (double y = -8; y <= 8; y += 1) pieces.push_back({Vec2(13 + x, -7 + y), 1});
  const TilePlace place = best_tile_place(*half_busy(), size, pieces, {0, 90});
  EXPECT_LT(place.trouble, 0.05);
  const PictureFrame frame(size, place.turn_deg, Repeat::kTile);
  for (const FilmPiece& piece : pieces) {
    const double x = frame.to_picture(piece.film_mm - place.shift_mm).x();
    EXPECT_LT(x - std::floor(x), 0.5);
  }
}

TEST(TilePlace, WithoutAnythingToHeedNothingMoves) {
  const TilePlace place = best_tile_place(*half_busy(), {40, 40}, {}, {0, 30});
  EXPECT_EQ(place.shift_mm, Vec2(0, 0));
  EXPECT_EQ(place.turn_deg, 0);
}

TEST(TilePlace, TellsSeamlessTilesFromOthers) {
  const auto wave = [](double cycles) {
    return painted(200, 200, [=](int x, int y) {
      const int grey = int(128 + 80 * std::sin(2 * kPi * cycles * (x + y) / 200.0));
      return std::array{grey, grey, grey, 255};
    });
  };
  EXPECT_TRUE(is_seamless(*wave(3)));
  EXPECT_FALSE(is_seamless(*wave(2.5)));
}

}  // namespace
}  // namespace hydrodip
