#include "transfer/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/blank_pages.h"
#include "base/parallel.h"
#include "image/blank_image.h"
#include "image/to_byte.h"
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

// A function over a pixel by its values in the upper left, upper right, lower left and lower right
// corner; 0 <= x, y <= 1 from the upper left one.
template <class Value, class Of>
double between(const std::array<Value, 4>& p, double x, double y, const Of& of) {
  return (1 - y) * ((1 - x) * of(p[0]) + x * of(p[1])) + y * ((1 - x) * of(p[2]) + x * of(p[3]));
}

// Where the corners of a tile's pixels land, each looked up once when it is first asked for.
class Corners {
 public:
  struct Corner {
    std::int32_t film_triangle = kUnasked;  // kNone: no film lies there
    SurfacePoint point;
  };
  static constexpr std::int32_t kUnasked = -2, kNone = -1;

  Corners(const FilmMap& map, const FilmGrid& grid, const Tile& tile)
      : map_(map), grid_(grid), tile_(tile), corners_(kStride * kStride) {}

  // Of a pixel: upper left, upper right, lower left, lower right; nothing if one of them lands
  // nowhere.
  std::optional<std::array<Corner, 4>> of_pixel(int x, int y) {
    std::array<Corner, 4> corners;
    for (int k = 0; k < 4; ++k) {
      corners[std::size_t(k)] = at(x + k % 2, y + k / 2);
      if (corners[std::size_t(k)].film_triangle == kNone) return std::nullopt;
    }
    return corners;
  }
  FilmMap::Cursor& cursor() { return cursor_; }

 private:
  static constexpr std::size_t kStride = kTile_px + 1;

  const Corner& at(int x, int y) {
    Corner& corner = corners_[std::size_t(y - tile_.y0) * kStride + std::size_t(x - tile_.x0)];
    if (corner.film_triangle != kUnasked) return corner;
    const auto point = map_.to_object(grid_.at(x, y), cursor_);
    corner.film_triangle = point ? cursor_.film_triangle : kNone;
    if (point) corner.point = *point;
    return corner;
  }

  const FilmMap& map_;
  const FilmGrid& grid_;
  const Tile tile_;
  FilmMap::Cursor cursor_;
  std::vector<Corner> corners_;
};

// How many pairs of a film's and an object's triangle there are at the corners.
std::size_t pairs_at(const std::array<Corners::Corner, 4>& corners) {
  std::size_t pairs = 0;
  for (std::size_t k = 0; k < 4; ++k)
    pairs += std::none_of(corners.begin(), corners.begin() + k, [&](const auto& before) {
      return before.film_triangle == corners[k].film_triangle &&
             before.point.triangle == corners[k].point.triangle;
    });
  return pairs;
}

// Where samples of a pixel land that several triangles share: each pair of a film's and an object's
// triangle among those of its corners, over the whole pixel.
class SharedPixel {
 public:
  SharedPixel(const FilmMap& map, const FilmGrid& grid, int x, int y,
              const std::array<Corners::Corner, 4>& corners)
      : map_(map),
        place_{grid.at(x, y), grid.at(x + 1, y), grid.at(x, y + 1), grid.at(x + 1, y + 1)} {
    for (const auto& film : corners)
      for (const auto& object : corners) add(film.film_triangle, object.point.triangle);
  }

  // At (x, y) from the upper left corner, of the pixel's side; nothing if none of them has it. In a
  // valley of the object two may have it: then the nearer one.
  std::optional<SurfacePoint> at(double x, double y) const {
    constexpr double kInside = -1e-9;
    std::optional<SurfacePoint> nearest;
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < count_; ++n) {
      const Pair& pair = pairs_[n];
      const auto mix = [&](const auto& of) { return between(pair.landing, x, y, of); };
      const double u = mix([](const FilmMap::Projection& p) { return p.point.u; });
      const double v = mix([](const FilmMap::Projection& p) { return p.point.v; });
      if (u < 0 || v < 0 || u + v > 1) continue;
      const auto weight = [&](Eigen::Index k) {
        return between(films_[pair.film].laid, x, y,
                       [k](const FilmMap::Laid& laid) { return laid.weight[k]; });
      };
      if (weight(0) < kInside || weight(1) < kInside || weight(2) < kInside) continue;
      const double distance_mm = mix([](const FilmMap::Projection& p) { return p.distance_mm; });
      if (distance_mm >= nearest_mm) continue;
      nearest_mm = distance_mm;
      nearest = SurfacePoint{pair.object_triangle, u, v};
    }
    return nearest;
  }

 private:
  struct Film {
    std::int32_t triangle;
    std::array<FilmMap::Laid, 4> laid;  // at the pixel's corners
  };
  struct Pair {
    std::size_t film;
    int object_triangle;
    std::array<FilmMap::Projection, 4> landing;
  };

  std::size_t film_of(std::int32_t triangle) {
    for (std::size_t n = 0; n < films_count_; ++n)
      if (films_[n].triangle == triangle) return n;
    Film& film = films_[films_count_];
    film.triangle = triangle;
    for (std::size_t k = 0; k < 4; ++k) film.laid[k] = map_.laid(place_[k], triangle);
    return films_count_++;
  }

  void add(std::int32_t film_triangle, int object_triangle) {
    const std::size_t film = film_of(film_triangle);
    for (std::size_t n = 0; n < count_; ++n)
      if (pairs_[n].film == film && pairs_[n].object_triangle == object_triangle) return;
    Pair& pair = pairs_[count_];
    pair.film = film;
    pair.object_triangle = object_triangle;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto landing = map_.onto(object_triangle, films_[film].laid[k]);
      if (!landing) return;
      pair.landing[k] = *landing;
    }
    ++count_;
  }

  const FilmMap& map_;
  std::array<Vec2, 4> place_;  // of the pixel's corners
  std::array<Film, 4> films_;
  std::size_t films_count_ = 0;
  std::array<Pair, 16> pairs_;
  std::size_t count_ = 0;
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

  // The mean over a pixel whose samples land on a grid of points.
  LinearColor mean(const SurfaceGrid& grid, const Samples& samples) const {
    if (textured_ != nullptr)
      if (const auto color = mean_texture_color(*textured_, grid, paint_.base())) return *color;
    const float weight = 1.0F / static_cast<float>(grid.per_axis * grid.per_axis);
    ColorSum sum;
    for (int row = 0; row < grid.per_axis; ++row)
      for (int column = 0; column < grid.per_axis; ++column)
        sum.add(at(grid.at(column, row), samples.at(column, row)), weight);
    return sum.color();
  }

 private:
  const Paint& paint_;
  const Allotment& allotment_;
  bool depends_on_film_;
  const Object* textured_;  // the paint, if it is nothing else; or null
};

// Where the samples of a pixel land if film and object are one triangle each at its corners.
SurfaceGrid grid_in(const std::array<Corners::Corner, 4>& corners, int per_axis) {
  const double step = 1.0 / per_axis, first = 0.5 * step;
  const auto mix = [&](double SurfacePoint::*part, double x, double y) {
    return between(corners, x, y, [part](const auto& corner) { return corner.point.*part; });
  };
  SurfaceGrid grid;
  grid.per_axis = per_axis;
  grid.first = {corners[0].point.triangle, mix(&SurfacePoint::u, first, first),
                mix(&SurfacePoint::v, first, first)};
  grid.u_across = mix(&SurfacePoint::u, first + step, first) - grid.first.u;
  grid.v_across = mix(&SurfacePoint::v, first + step, first) - grid.first.v;
  grid.u_down = mix(&SurfacePoint::u, first, first + step) - grid.first.u;
  grid.v_down = mix(&SurfacePoint::v, first, first + step) - grid.first.v;
  return grid;
}

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
  std::optional<SharedPixel> shared;
  if (const auto corners = tile.of_pixel(x, y)) {
    const std::size_t pairs = pairs_at(*corners);
    if (pairs == 1) return printed.mean(grid_in(*corners, n), samples);
    // Where each corner has another, there are likely more of them between.
    if (pairs < 4) shared.emplace(map, grid, x, y, *corners);
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
  const float weight = 1.0f / static_cast<float>(n * n);
  ColorSum sum;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec2 u = samples.at(i, j);
      auto point = shared ? shared->at((i + 0.5) / n, (j + 0.5) / n) : std::nullopt;
      if (!point) point = map.to_object(u, cursor);
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
