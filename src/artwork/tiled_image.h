// Pictures too large to be kept whole: square tiles, of which those of one colour cost nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/image.h"

namespace hydrodip {

// 8-bit sRGB with straight alpha, as Image. Row 0 is the top row.
class TiledImage {
 public:
  static constexpr int kTile_px = 64;

  TiledImage() = default;
  TiledImage(int width_px, int height_px);  // fully transparent black

  // Copies a block of pixels whose left upper corner comes to lie there: at a tile's corner. The
  // block ends at a tile's edge or at the picture's.
  void put(const Image& block, int left, int top);

  const std::uint8_t* pixel(int x, int y) const {
    const Tile& tile = tiles_[std::size_t(y / kTile_px) * across_ + std::size_t(x / kTile_px)];
    if (tile.pixels.empty()) return tile.color.data();
    return tile.pixels.data() + 4 * ((y % kTile_px) * kTile_px + x % kTile_px);
  }

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  // Of the tiles that have more than one colour.
  std::size_t bytes() const { return bytes_; }
  bool shows_anything() const;

 private:
  struct Tile {
    std::vector<std::uint8_t> pixels;  // none: all of one colour
    std::array<std::uint8_t, 4> color{};
  };
  int width_px_ = 0, height_px_ = 0;
  std::size_t across_ = 0, bytes_ = 0;
  std::vector<Tile> tiles_;
};

}  // namespace hydrodip
