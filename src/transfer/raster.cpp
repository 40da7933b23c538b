#include "transfer/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/blank_pages.h"
#include "base/parallel.h"
#include "image/blank_image.h"
#include "image/to_byte.h"
#include "transfer/shared_pixel.h"
#include "transfer/texture_mean.h"

namespace hydrodip {

namespace {

constexpr int kTile_px = 64;
constexpr std::size_t kTilesPerRound = 256;

// Averages colours by their coverage, in linear light.
struct ColorSum {
  float r = 0, g = 0, b = 0, a = 0;
  void add(const LinearColor& c, float weight) {
    r += weight * c.a * c.r;
    g += weight * c.a * c.g;
    b += weight * c.a * c.b;
    a += weight * c.a;
  }
  LinearColor color() const {
    if (!(a > 0)) return {0, 0, 0, 0};
    return {r / a, g / a, b / a, a};
  }
};

struct Tile {
  int x0, y0, x1, y1;
};

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

// SheetRaster::to_film for many pixels.
class FilmGrid {
 public:
  explicit FilmGrid(const SheetRaster& raster)
      : pixel_mm_(kMmPerInch / raster.dpi),
        centre_x_(0.5 * raster.width_px()),
        centre_y_(0.5 * raster.height_px()) {}
  double pixel_mm() const { return pixel_mm_; }
  Vec2 at(double x_px, double y_px) const {
    return {(x_px - centre_x_) * pixel_mm_, (centre_y_ - y_px) * pixel_mm_};
  }

 private:
  double pixel_mm_, centre_x_, centre_y_;
};

// The samples of a pixel, on a regular grid inside it.
struct Samples {
  Vec2 corner;  // of the pixel, in film coordinates
  double pixel_mm;
  int per_axis;
  Vec2 at(int i, int j) const {
    const double step = pixel_mm / per_axis;
    return {corner.x() + (i + 0.5) * step, corner.y() - (j + 0.5) * step};
  }
};

// Where the corners of a tile's pixels land, for pixels row by row: each is looked up once when it
// is first asked for.
class Corners {
 public:
  Corners(const FilmMap& map, const FilmGrid& grid, const Tile& tile)
      : map_(map), grid_(grid), tile_(tile) {}

  // Of a pixel; nothing if one of them lands nowhere.
  std::optional<PixelCorners> of_pixel(int x, int y) {
    PixelCorners corners;
    for (int k = 0; k < 4; ++k) {
      const Entry& entry = at(x + k % 2, y + k / 2);
      if (!entry.lands) return std::nullopt;
      corners[std::size_t(k)] = &entry.corner;
    }
    return corners;
  }
  FilmMap::Cursor& cursor() { return cursor_; }

 private:
  struct Entry {
    int y = -1;  // whose it is; of no row yet
    bool lands = false;
    PixelCorner corner;
  };

  const Entry& at(int x, int y) {
    Entry& entry = rows_[std::size_t(y % 2)][std::size_t(x - tile_.x0)];
    if (entry.y == y) return entry;
    entry.y = y;
    PixelCorner& corner = entry.corner;
    corner.film_mm = grid_.at(x, y);
    const auto point = map_.to_object(corner.film_mm, cursor_, corner.laid);
    entry.lands = point.has_value();
    if (point) corner.point = *point;
    corner.film_triangle = cursor_.film_triangle;
    return entry;
  }

  const FilmMap& map_;
  const FilmGrid& grid_;
  const Tile tile_;
  FilmMap::Cursor cursor_;
  std::array<std::array<Entry, kTile_px + 1>, 2> rows_;  // two are in use at a time
};

// Darker than that no ink is, so that a part of it can be told.
constexpr float kDarkest = 0.003F;

// A part of the ink that makes `base` look like `wanted`: ink is a filter, so that the parts of
// several films multiply to what the whole ink leaves of the light.
LinearColor part_of_ink(const LinearColor& wanted, const LinearColor& base, float share) {
  const auto part = [&](float w, float b) {
    if (!(b > 0)) return w;
    return b * std::pow(std::clamp(w / b, kDarkest, 1.0F), share);
  };
  return {part(wanted.r, base.r), part(wanted.g, base.g), part(wanted.b, base.b), wanted.a};
}

// What is printed of a point of the object.
class Printed {
 public:
  Printed(const Paint& paint, const Allotment& allotment)
      : paint_(paint),
        allotment_(allotment),
        depends_on_film_(paint.depends_on_film()),
        textured_(allotment.is_full() && !depends_on_film_ ? paint.as_object() : nullptr) {}

  // `film`: where on the film it is printed.
  LinearColor at(const SurfacePoint& point, const Vec2& film) const {
    const LinearColor color =
        depends_on_film_ ? paint_.color_on_film(point, film) : paint_.color_at(point);
    const float share = allotment_.at(point);
    if (share >= 1) return color;
    if (share <= 0) return {0, 0, 0, 0};
    return part_of_ink(color, paint_.base(), share);
  }

  // The mean over those of a pixel's samples that land on a grid's points.
  LinearColor mean(const SurfaceGrid& grid, const Samples& samples) const {
    if (textured_ != nullptr)
      if (const auto color = mean_texture_color(*textured_, grid, paint_.base())) return *color;
    const float weight = 1.0F / static_cast<float>(grid.count());
    ColorSum sum;
    for (int row = 0; row < grid.per_axis; ++row)
      for (int column = 0; column < grid.per_axis; ++column)
        if (grid.counts(column, row))
          sum.add(at(grid.at(column, row), samples.at(column, row)), weight);
    return sum.color();
  }

 private:
  const Paint& paint_;
  const Allotment& allotment_;
  bool depends_on_film_;
  const Object* textured_;  // the paint, if it is nothing else; or null
};

// One pixel of the film image.
LinearColor pixel_color(const Printed& printed, const FilmMap& map, const FilmGrid& grid,
                        const InverseOptions& options, int x, int y, Corners& tile) {
  const int n = options.samples_per_axis;
  const Samples samples{grid.at(x, y), grid.pixel_mm(), n};
  FilmMap::Cursor& cursor = tile.cursor();
  if (options.quick_look) {
    const Vec2 centre = grid.at(x + 0.5, y + 0.5);
    auto point = map.to_object(centre, cursor);
    if (!point && options.bleed_mm > 0)
      if (const auto near = map.nearest_covered(centre, options.bleed_mm, cursor))
        point = map.to_object(*near, cursor);
    return point ? printed.at(*point, centre) : LinearColor{0, 0, 0, 0};
  }
  const float weight = 1.0f / static_cast<float>(n * n);
  ColorSum sum;
  std::uint64_t unknown = ~std::uint64_t(0);  // the samples that are still to be looked up
  if (const auto corners = tile.of_pixel(x, y)) {
    if (on_one_pair(*corners)) return printed.mean(grid_between(*corners, n), samples);
    const SharedPixel shared(map, *corners, n);
    for (const SurfaceGrid& part : shared.grids())
      if (part.count() > 0) sum.add(printed.mean(part, samples), weight * float(part.count()));
    unknown = shared.unknown();
  } else {
    // One look for all samples: out of reach, or in the midst of the bleed, which shows little.
    const double radius = 0.71 * grid.pixel_mm();
    const Vec2 centre = grid.at(x + 0.5, y + 0.5);
    const auto nearest = map.nearest_covered(centre, options.bleed_mm + radius, cursor);
    if (!nearest) return {0, 0, 0, 0};
    const double distance = (*nearest - centre).norm();
    if (distance > radius && distance + radius < options.bleed_mm)
      if (const auto point = map.to_object(*nearest, cursor)) return printed.at(*point, centre);
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if ((unknown >> (j * n + i) & 1U) == 0) continue;
      const Vec2 u = samples.at(i, j);
      auto point = map.to_object(u, cursor);
      if (!point && options.bleed_mm > 0)
        if (const auto near = map.nearest_covered(u, options.bleed_mm, cursor))
          point = map.to_object(*near, cursor);
      if (point) sum.add(printed.at(*point, u), weight);
    }
  return sum.color();
}

void store(const LinearColor& color, std::uint8_t* pixel) {
  pixel[0] = linear_to_srgb8(color.r);
  pixel[1] = linear_to_srgb8(color.g);
  pixel[2] = linear_to_srgb8(color.b);
  pixel[3] = to_byte(color.a);
  if (pixel[3] == 0) pixel[0] = pixel[1] = pixel[2] = 0;
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
  Image image = blank_image(raster.width_px(), raster.height_px());
  const Printed printed(paint, allotment);
  const FilmGrid grid(raster);
  for_inked_tiles(map, raster, options.bleed_mm, "rastering", context, [&](const Tile& tile) {
    Corners corners(map, grid, tile);
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        store(pixel_color(printed, map, grid, options, x, y, corners), image.pixel(x, y));
  });
  return image;
}

FilmStretch film_stretch(const FilmMap& map, const SheetRaster& raster, double bleed_mm,
                         const RunContext& context) {
  const auto width = std::size_t(raster.width_px());
  const FilmGrid grid(raster);
  FilmStretch result;
  result.area_ratio = blank<float>(width * std::size_t(raster.height_px()));
  result.on_object = blank<std::uint8_t>(result.area_ratio.size());
  for_inked_tiles(map, raster, bleed_mm, "measuring the stretch", context, [&](const Tile& tile) {
    FilmMap::Cursor cursor;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        const Vec2 u = grid.at(x + 0.5, y + 0.5);
        // Not less than the outline's hair.
        const auto near = map.nearest_covered(u, std::max(bleed_mm, 1e-3), cursor);
        if (!near) continue;
        const std::size_t i = std::size_t(y) * width + std::size_t(x);
        result.area_ratio[i] = static_cast<float>(map.area_ratio(*near, cursor));
        result.on_object[i] = *near == u;
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
