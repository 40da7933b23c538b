#include "transfer/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/blank_array.h"
#include "base/parallel.h"
#include "image/to_byte.h"
#include "transfer/color_sum.h"
#include "transfer/tile_colors.h"
#include "transfer/triangle_samples.h"

namespace hydrodip {

namespace {

constexpr std::size_t kTilesPerRound = 256;

std::vector<Tile> tiles_of(int width_px, int height_px) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height_px; y += kTile_px)
    for (int x = 0; x < width_px; x += kTile_px)
      tiles.push_back({x, y, std::min(x + kTile_px, width_px), std::min(y + kTile_px, height_px)});
  return tiles;
}

// A little more than what rounding leaves out.
constexpr double kTileSlack_mm = 1e-6;

bool may_hold_ink(const Tile& tile, const SheetRaster& raster, const FilmMap& map,
                  double bleed_mm) {
  const Vec2 corner = raster.to_film(tile.x0, tile.y0);
  const Vec2 centre = raster.to_film(0.5 * (tile.x0 + tile.x1), 0.5 * (tile.y0 + tile.y1));
  const double reach = (corner - centre).norm() + bleed_mm + kTileSlack_mm;
  return map.nearest_covered(centre, reach).has_value();
}

// The triangles of film on the object under every tile.
class FilmUnderTiles {
 public:
  FilmUnderTiles(const FilmMap& map, const SheetRaster& raster)
      : columns_(count(raster.width_px())), triangles_(columns_ * count(raster.height_px())) {
    for (const std::int32_t triangle : map.lying()) {
      Vec2 least = Vec2::Constant(std::numeric_limits<double>::infinity()), most = -least;
      for (const Vec2& corner : map.lying(triangle).film_mm) {
        const Vec2 at = raster.to_pixel(corner);
        least = least.cwiseMin(at);
        most = most.cwiseMax(at);
      }
      add(triangle, least, most);
    }
  }

  const std::vector<std::int32_t>& under(const Tile& tile) const {
    return triangles_[std::size_t(tile.y0 / kTile_px) * columns_ + std::size_t(tile.x0 / kTile_px)];
  }

 private:
  static std::size_t count(int size_px) { return std::size_t((size_px + kTile_px - 1) / kTile_px); }

  void add(std::int32_t triangle, const Vec2& least_px, const Vec2& most_px) {
    const auto rows = triangles_.size() / columns_;
    const auto tile_at = [](double px, std::size_t tiles) {
      return std::size_t(std::clamp(px / kTile_px, 0.0, double(tiles - 1)));
    };
    for (std::size_t y = tile_at(least_px.y(), rows); y <= tile_at(most_px.y(), rows); ++y)
      for (std::size_t x = tile_at(least_px.x(), columns_); x <= tile_at(most_px.x(), columns_);
           ++x)
        triangles_[y * columns_ + x].push_back(triangle);
  }

  std::size_t columns_;
  std::vector<std::vector<std::int32_t>> triangles_;
};

void store(const LinearColor& color, std::uint8_t* pixel) {
  pixel[0] = linear_to_srgb8(color.r);
  pixel[1] = linear_to_srgb8(color.g);
  pixel[2] = linear_to_srgb8(color.b);
  pixel[3] = to_byte(color.a);
  if (pixel[3] == 0) pixel[0] = pixel[1] = pixel[2] = 0;
}

bool is_same(const LinearColor& one, const LinearColor& other) {
  return one.r == other.r && one.g == other.g && one.b == other.b && one.a == other.a;
}

// A row's; neighbours are often alike.
void store(const LinearColor* colors, int count, std::uint8_t* pixels) {
  for (int x = 0; x < count; ++x, pixels += 4)
    if (x > 0 && is_same(colors[x], colors[x - 1]))
      std::copy_n(pixels - 4, 4, pixels);
    else
      store(colors[x], pixels);
}

}  // namespace

int SheetRaster::width_px() const {
  return std::max(1, static_cast<int>(std::lround(width_mm / kMmPerInch * dpi)));
}
int SheetRaster::height_px() const {
  return std::max(1, static_cast<int>(std::lround(height_mm / kMmPerInch * dpi)));
}
Vec2 SheetRaster::to_film(double x_px, double y_px) const {
  const double pixel_mm = kMmPerInch / dpi;
  return {(x_px - 0.5 * width_px()) * pixel_mm, (0.5 * height_px() - y_px) * pixel_mm};
}
Vec2 SheetRaster::to_pixel(const Vec2& u) const {
  const double pixel_mm = kMmPerInch / dpi;
  return {u.x() / pixel_mm + 0.5 * width_px(), 0.5 * height_px() - u.y() / pixel_mm};
}

namespace {

// paint(tile) for every tile that may carry ink, on any thread; progress as `stage`.
template <class Paint>
void for_inked_tiles(const FilmMap& map, const SheetRaster& raster, double bleed_mm,
                     const std::string& stage, const RunContext& context, const Paint& paint) {
  const RunScope scope(context);
  std::vector<Tile> tiles = tiles_of(raster.width_px(), raster.height_px());
  std::erase_if(tiles, [&](const Tile& t) {
    check_cancelled();
    return !may_hold_ink(t, raster, map, bleed_mm);
  });
  // In rounds, so that progress comes from this thread.
  for (std::size_t first = 0; first < tiles.size(); first += kTilesPerRound) {
    context.progress(stage, double(first) / double(tiles.size()));
    const std::size_t count = std::min(kTilesPerRound, tiles.size() - first);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) paint(tiles[first + i]);
    });
  }
  context.progress(stage, 1);
}

}  // namespace

SheetRaster raster_of(const FilmOptions& film, double dpi) {
  return {film.width_mm, film.height_mm, dpi};
}

Image film_image(const Paint& paint, const FilmMap& map, const SheetRaster& raster,
                 const InverseOptions& options, const Allotment& allotment,
                 const RunContext& context) {
  Image image(raster.width_px(), raster.height_px());
  const Printed printed(paint, allotment);
  const FilmUnderTiles film(map, raster);
  for_inked_tiles(map, raster, options.bleed_mm, "rastering", context, [&](const Tile& tile) {
    TileColors colors(printed, map, raster, options, tile, film.under(tile));
    std::array<LinearColor, kTile_px> row;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) row[std::size_t(x - tile.x0)] = colors.of_pixel(x, y);
      store(row.data(), tile.x1 - tile.x0, image.pixel(tile.x0, y));
    }
  });
  return image;
}

FilmStretch film_stretch(const FilmMap& map, const SheetRaster& raster, double bleed_mm,
                         const RunContext& context) {
  const auto width = std::size_t(raster.width_px());
  const FilmUnderTiles film(map, raster);
  FilmStretch result;
  result.area_ratio = BlankArray<float>(width * std::size_t(raster.height_px()));
  result.on_object = BlankArray<std::uint8_t>(result.area_ratio.size());
  for_inked_tiles(map, raster, bleed_mm, "measuring the stretch", context, [&](const Tile& tile) {
    const SampleGrid centres = samples_of(tile, raster, 1);
    const auto index = [&](int column, int row) {
      return std::size_t(tile.y0 + row) * width + std::size_t(tile.x0 + column);
    };
    for (const std::int32_t triangle : film.under(tile)) {
      const LyingTriangle lying = map.lying(triangle);
      const TriangleSamples samples(lying, centres);
      const LinearOnGrid ratio = samples.linear(lying.area_ratio);
      for (int row = samples.rows().begin; row < samples.rows().end; ++row)
        for (int column = samples.in_row(row).begin; column < samples.in_row(row).end; ++column) {
          result.area_ratio[index(column, row)] = static_cast<float>(ratio.at(column, row));
          result.on_object[index(column, row)] = 1;
        }
    }
    // Beside the film: of the nearest that is, but not less than the outline's hair away.
    FilmMap::Cursor cursor;
    for (int row = 0; row < centres.rows; ++row)
      for (int column = 0; column < centres.columns; ++column) {
        if (result.on_object[index(column, row)] != 0) continue;
        const auto near =
            map.nearest_covered(centres.at(column, row), std::max(bleed_mm, 1e-3), cursor);
        if (near)
          result.area_ratio[index(column, row)] = static_cast<float>(map.area_ratio(*near, cursor));
      }
  });
  return result;
}

LinearColor sample_film_image(const Image& image, const SheetRaster& raster, const Vec2& u) {
  const double pixels_per_mm = raster.dpi / kMmPerInch;
  const double x = u.x() * pixels_per_mm + 0.5 * image.width_px - 0.5;
  const double y = 0.5 * image.height_px - u.y() * pixels_per_mm - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  ColorSum sum;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      const int px = x0 + dx, py = y0 + dy;
      if (px < 0 || py < 0 || px >= image.width_px || py >= image.height_px) continue;
      const std::uint8_t* pixel = image.pixel(px, py);
      sum.add({srgb8_to_linear(pixel[0]), srgb8_to_linear(pixel[1]), srgb8_to_linear(pixel[2]),
               static_cast<float>(pixel[3]) / 255.0f},
              (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy));
    }
  return sum.color();
}

LinearColor predicted_color(const Image& image, const SheetRaster& raster, const FilmMap& map,
                            const Vec3& position, const Vec3& normal, const LinearColor& base) {
  const auto u = map.to_film(position, normal);
  const LinearColor ink = u ? sample_film_image(image, raster, *u) : LinearColor{0, 0, 0, 0};
  const float bare = 1 - ink.a;
  return {ink.a * ink.r + bare * base.r, ink.a * ink.g + bare * base.g,
          ink.a * ink.b + bare * base.b, 1};
}

}  // namespace hydrodip
