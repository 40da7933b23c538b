#include "transfer/raster.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/blank_pages.h"
#include "base/parallel.h"
#include "image/blank_image.h"
#include "image/to_byte.h"
#include "transfer/sample_landings.h"
#include "transfer/texture_mean.h"
#include "transfer/texture_row.h"

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

// The samples of a tile's pixels, so many in each direction of each.
SampleGrid samples_of(const Tile& tile, const SheetRaster& raster, int per_axis) {
  const double step_px = 1.0 / per_axis;
  return {raster.to_film(tile.x0 + 0.5 * step_px, tile.y0 + 0.5 * step_px),
          kMmPerInch / raster.dpi * step_px, (tile.x1 - tile.x0) * per_axis,
          (tile.y1 - tile.y0) * per_axis};
}

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

  // Whether `row` has anything to tell.
  bool is_told_by_row() const { return textured_ != nullptr && textured_->colors.empty(); }
  TextureRow row(const FilmOnPlane& pair) const { return {*textured_, pair, paint_.base()}; }

  // `film`: where on the film it is printed.
  LinearColor at(const SurfacePoint& point, const Vec2& film) const {
    const LinearColor color =
        depends_on_film_ ? paint_.color_on_film(point, film) : paint_.color_at(point);
    const float share = allotment_.at(point);
    if (share >= 1) return color;
    if (share <= 0) return {0, 0, 0, 0};
    return part_of_ink(color, paint_.base(), share);
  }

  // Of the points that count of some grids, if it is told at once.
  std::optional<LinearColor> mean(std::span<const SurfaceGrid> grids) const {
    if (textured_ == nullptr) return std::nullopt;
    return mean_texture_color(*textured_, grids, paint_.base());
  }

 private:
  const Paint& paint_;
  const Allotment& allotment_;
  bool depends_on_film_;
  const Object* textured_;  // the paint, if it is nothing else; or null
};

// The samples of a pixel by what they land on.
class PixelShares {
 public:
  struct Share {
    std::int32_t pair;      // of the landings
    std::uint64_t samples;  // as SurfaceGrid::counted
  };

  PixelShares(const SampleLandings& landings, int column, int row, int per_axis) {
    std::uint64_t sample = 1;
    for (int j = 0; j < per_axis; ++j)
      for (int i = 0; i < per_axis; ++i, sample <<= 1)
        add(landings.pair_at(column + i, row + j), sample);
  }

  std::span<const Share> found() const { return {shares_.data(), count_}; }
  std::uint64_t unknown() const { return unknown_; }

 private:
  void add(std::int32_t pair, std::uint64_t sample) {
    if (pair == SampleLandings::kNone) {
      unknown_ |= sample;
      return;
    }
    std::size_t n = 0;
    while (n < count_ && shares_[n].pair != pair) ++n;
    if (n == count_) shares_[count_++] = {pair, 0};
    shares_[n].samples |= sample;
  }

  static constexpr std::size_t kMostSamples =
      std::size_t(SurfaceGrid::kMostPerAxis) * std::size_t(SurfaceGrid::kMostPerAxis);
  std::array<Share, kMostSamples> shares_;
  std::size_t count_ = 0;
  std::uint64_t unknown_ = 0;
};

// What is printed on the film of a tile.
class TileColors {
 public:
  TileColors(const Printed& printed, const FilmMap& map, const SheetRaster& raster,
             const InverseOptions& options, const Tile& tile,
             const std::vector<std::int32_t>& film_triangles)
      : printed_(printed),
        map_(map),
        bleed_mm_(options.bleed_mm),
        tile_(tile),
        per_axis_(options.quick_look ? 1 : options.samples_per_axis),
        samples_(samples_of(tile, raster, per_axis_)),
        landings_(map, samples_, film_triangles) {}

  // One for each of a row's pixels.
  void of_row(int y, std::span<LinearColor> colors) {
    const int row = (y - tile_.y0) * per_axis_, width = tile_.x1 - tile_.x0;
    for (int x = 0, end = 0; x < width; x = end) {
      const std::int32_t pair =
          printed_.is_told_by_row() ? pair_of_pixel(x, row) : SampleLandings::kNone;
      for (end = x + 1; end < width && pair != SampleLandings::kNone; ++end)
        if (pair_of_pixel(end, row) != pair) break;
      if (pair == SampleLandings::kNone)
        colors[std::size_t(x)] = of_pixel(x * per_axis_, row);
      else
        of_one_pair(pair, x, end, row, colors);
    }
  }

 private:
  // Which holds all its samples, or kNone.
  std::int32_t pair_of_pixel(int x, int row) const {
    const int column = x * per_axis_;
    const std::int32_t pair = landings_.pair_at(column, row);
    for (int j = 0; j < per_axis_; ++j)
      for (int i = 0; i < per_axis_; ++i)
        if (landings_.pair_at(column + i, row + j) != pair) return SampleLandings::kNone;
    return pair;
  }

  void of_one_pair(std::int32_t pair, int begin, int end, int row, std::span<LinearColor> colors) {
    std::array<std::optional<LinearColor>, kTile_px> means;
    const std::span<std::optional<LinearColor>> known(means.data(), std::size_t(end - begin));
    printed_.row(landings_.pair(pair)).means(begin * per_axis_, row, per_axis_, known);
    for (int x = begin; x < end; ++x) {
      const auto& mean = known[std::size_t(x - begin)];
      colors[std::size_t(x)] = mean ? *mean : of_pixel(x * per_axis_, row);
    }
  }

  LinearColor of_pixel(int column, int row) {
    const PixelShares shares(landings_, column, row, per_axis_);
    if (shares.found().empty())
      if (const auto color = beside_film(column, row)) return *color;
    ColorSum sum;
    add_found(shares, column, row, sum);
    for (std::uint64_t left = shares.unknown(); left != 0; left &= left - 1) {
      const int sample = std::countr_zero(left);
      const int i = sample % per_axis_, j = sample / per_axis_;
      const Vec2 film_mm = samples_.at(column + i, row + j);
      if (const auto point = landing(film_mm)) sum.add(printed_.at(*point, film_mm), weight());
    }
    return sum.color();
  }

  float weight() const { return 1.0F / static_cast<float>(per_axis_ * per_axis_); }

  // Together if they can be, else grid by grid, or sample by sample.
  void add_found(const PixelShares& shares, int column, int row, ColorSum& sum) const {
    constexpr std::size_t kTogether = 6;
    std::array<SurfaceGrid, kTogether> grids;
    std::size_t count = 0;
    if (shares.found().size() <= kTogether) {
      for (const PixelShares::Share& share : shares.found())
        grids[count++] = grid_of(share, column, row);
      if (const auto mean = printed_.mean({grids.data(), count})) {
        sum.add(*mean, weight() * static_cast<float>(per_axis_ * per_axis_ -
                                                     std::popcount(shares.unknown())));
        return;
      }
    }
    for (const PixelShares::Share& share : shares.found())
      add_grid(grid_of(share, column, row), column, row, sum);
  }

  SurfaceGrid grid_of(const PixelShares::Share& share, int column, int row) const {
    SurfaceGrid grid = landings_.landing(share.pair, column, row, per_axis_);
    grid.counted = share.samples;
    return grid;
  }

  void add_grid(const SurfaceGrid& grid, int column, int row, ColorSum& sum) const {
    if (const auto mean = printed_.mean({&grid, 1})) {
      sum.add(*mean, weight() * static_cast<float>(grid.count()));
      return;
    }
    for (int j = 0; j < per_axis_; ++j)
      for (int i = 0; i < per_axis_; ++i)
        if (grid.counts(i, j))
          sum.add(printed_.at(grid.at(i, j), samples_.at(column + i, row + j)), weight());
  }

  // One look for all samples of a pixel: out of reach, or in the midst of the bleed, which shows
  // little.
  std::optional<LinearColor> beside_film(int column, int row) {
    const double middle = 0.5 * (per_axis_ - 1), radius_mm = 0.71 * per_axis_ * samples_.step_mm;
    const Vec2 film_mm = samples_.at(column + middle, row + middle);
    const auto nearest = map_.nearest_covered(film_mm, bleed_mm_ + radius_mm, cursor_);
    if (!nearest) return LinearColor{0, 0, 0, 0};
    const double distance_mm = (*nearest - film_mm).norm();
    if (distance_mm > radius_mm && distance_mm + radius_mm < bleed_mm_)
      if (const auto point = map_.to_object(*nearest, cursor_)) return printed_.at(*point, film_mm);
    return std::nullopt;
  }

  // Where film or, in its bleed, the film next to it lands.
  std::optional<SurfacePoint> landing(const Vec2& film_mm) {
    const auto point = map_.to_object(film_mm, cursor_);
    if (point || !(bleed_mm_ > 0)) return point;
    const auto near = map_.nearest_covered(film_mm, bleed_mm_, cursor_);
    return near ? map_.to_object(*near, cursor_) : std::nullopt;
  }

  const Printed& printed_;
  const FilmMap& map_;
  const double bleed_mm_;
  const Tile tile_;
  const int per_axis_;
  const SampleGrid samples_;
  const SampleLandings landings_;
  FilmMap::Cursor cursor_;
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
  Image image = blank_image(raster.width_px(), raster.height_px());
  const Printed printed(paint, allotment);
  const FilmUnderTiles film(map, raster);
  for_inked_tiles(map, raster, options.bleed_mm, "rastering", context, [&](const Tile& tile) {
    TileColors colors(printed, map, raster, options, tile, film.under(tile));
    std::array<LinearColor, kTile_px> row;
    for (int y = tile.y0; y < tile.y1; ++y) {
      colors.of_row(y, row);
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
  result.area_ratio = blank<float>(width * std::size_t(raster.height_px()));
  result.on_object = blank<std::uint8_t>(result.area_ratio.size());
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
