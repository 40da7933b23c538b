#include "artwork/tiled_image.h"

#include <algorithm>
#include <cstring>

namespace hydrodip {
namespace {

std::size_t tiles_in(int length_px) {
  return std::size_t((length_px + TiledImage::kTile_px - 1) / TiledImage::kTile_px);
}

bool has_one_color(const Image& block, int left, int top, int width, int height) {
  const std::uint8_t* first = block.pixel(left, top);
  for (int y = top; y < top + height; ++y) {
    const std::uint8_t* row = block.pixel(left, y);
    for (int x = 0; x < width; ++x)
      if (std::memcmp(row + 4 * x, first, 4) != 0) return false;
  }
  return true;
}

}  // namespace

TiledImage::TiledImage(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      across_(tiles_in(width_px)),
      tiles_(across_ * tiles_in(height_px)) {}

void TiledImage::put(const Image& block, int left, int top) {
  constexpr std::size_t kTileBytes = std::size_t(4) * kTile_px * kTile_px;
  for (int y = 0; y < block.height_px; y += kTile_px)
    for (int x = 0; x < block.width_px; x += kTile_px) {
      const int width = std::min(kTile_px, block.width_px - x);
      const int height = std::min(kTile_px, block.height_px - y);
      Tile& tile =
          tiles_[std::size_t((top + y) / kTile_px) * across_ + std::size_t((left + x) / kTile_px)];
      if (has_one_color(block, x, y, width, height)) {
        std::copy_n(block.pixel(x, y), 4, tile.color.begin());
        continue;
      }
      tile.pixels.resize(kTileBytes);
      bytes_ += kTileBytes;
      for (int row = 0; row < height; ++row)
        std::copy_n(block.pixel(x, y + row), 4 * width,
                    &tile.pixels[4 * std::size_t(row * kTile_px)]);
    }
}

bool TiledImage::shows_anything() const {
  return std::any_of(tiles_.begin(), tiles_.end(), [](const Tile& tile) {
    if (tile.pixels.empty()) return tile.color[3] > 0;
    for (std::size_t i = 3; i < tile.pixels.size(); i += 4)
      if (tile.pixels[i] > 0) return true;
    return false;
  });
}

}  // namespace hydrodip
