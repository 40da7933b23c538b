// What is printed on the film of a tile, a small rectangle of a sheet's pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "transfer/film_map.h"
#include "transfer/printed.h"
#include "transfer/raster.h"
#include "transfer/sample_landings.h"
#include "transfer/triangle_samples.h"

namespace hydrodip {

constexpr int kTile_px = 64;  // its width and height, at most

struct Tile {
  int x0, y0, x1, y1;  // [x0, x1) x [y0, y1)
};

// The samples of a tile's pixels, so many in each direction of each.
SampleGrid samples_of(const Tile& tile, const SheetRaster& raster, int per_axis);

// Of one thread; refers to what is printed and to the map.
class TileColors {
 public:
  // `film_triangles`: all of FilmMap::lying() of which a part may be under the tile.
  TileColors(const Printed& printed, const FilmMap& map, const SheetRaster& raster,
             const InverseOptions& options, const Tile& tile,
             const std::vector<std::int32_t>& film_triangles);

  // Of a pixel of the sheet that is the tile's.
  LinearColor of_pixel(int x, int y);

 private:
  std::optional<LinearColor> beside_film(int column, int row);
  std::optional<SurfacePoint> landing(const Vec2& film_mm);

  const Printed& printed_;
  const FilmMap& map_;
  const double bleed_mm_;
  const Tile tile_;
  const int per_axis_;
  const SampleGrid samples_;
  const SampleLandings landings_;
  FilmMap::Cursor cursor_;
};

}  // namespace hydrodip
