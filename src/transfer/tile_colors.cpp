#include "transfer/tile_colors.h"

#include <array>
#include <bit>

namespace hydrodip {

SampleGrid samples_of(const Tile& tile, const SheetRaster& raster, int per_axis) {
  const double step_px = 1.0 / per_axis;
  return {raster.to_film(tile.x0 + 0.5 * step_px, tile.y0 + 0.5 * step_px),
          kMmPerInch / raster.dpi * step_px, (tile.x1 - tile.x0) * per_axis,
          (tile.y1 - tile.y0) * per_axis};
}

// The samples of a pixel by what they land on.
class TileColors::Shares {
 public:
  struct Share {
    std::int32_t pair;      // of the landings
    std::uint64_t samples;  // as SurfaceGrid::counted
  };

  Shares(const SampleLandings& landings, int column, int row, int per_axis) {
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

TileColors::TileColors(const Printed& printed, const FilmMap& map, const SheetRaster& raster,
                       const InverseOptions& options, const Tile& tile,
                       const std::vector<std::int32_t>& film_triangles)
    : printed_(printed),
      map_(map),
      bleed_mm_(options.bleed_mm),
      tile_(tile),
      per_axis_(options.quick_look ? 1 : options.samples_per_axis),
      samples_(samples_of(tile, raster, per_axis_)),
      landings_(map, samples_, film_triangles) {}

void TileColors::of_row(int y, std::span<LinearColor> colors) {
  const int row = (y - tile_.y0) * per_axis_, width = tile_.x1 - tile_.x0;
  for (int x = 0, end = 0; x < width; x = end) {
    const std::int32_t pair =
        printed_.is_told_by_row() ? pair_of_pixel(x, row) : SampleLandings::kNone;
    end = x + 1;
    if (pair == SampleLandings::kNone) {
      colors[std::size_t(x)] = of_pixel(x * per_axis_, row);
      continue;
    }
    while (end < width && pair_of_pixel(end, row) == pair) ++end;
    of_one_pair(pair, x, end, row, colors);
  }
}

// Which holds all its samples, or kNone.
std::int32_t TileColors::pair_of_pixel(int x, int row) const {
  const int column = x * per_axis_;
  const std::int32_t pair = landings_.pair_at(column, row);
  for (int j = 0; j < per_axis_; ++j)
    for (int i = 0; i < per_axis_; ++i)
      if (landings_.pair_at(column + i, row + j) != pair) return SampleLandings::kNone;
  return pair;
}

void TileColors::of_one_pair(std::int32_t pair, int begin, int end, int row,
                             std::span<LinearColor> colors) {
  std::array<std::optional<LinearColor>, kTile_px> means;
  const std::span<std::optional<LinearColor>> known(means.data(), std::size_t(end - begin));
  printed_.row(landings_.pair(pair)).means(begin * per_axis_, row, per_axis_, known);
  for (int x = begin; x < end; ++x) {
    const auto& mean = known[std::size_t(x - begin)];
    colors[std::size_t(x)] = mean ? *mean : of_pixel(x * per_axis_, row);
  }
}

LinearColor TileColors::of_pixel(int column, int row) {
  const Shares shares(landings_, column, row, per_axis_);
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

// Together if they can be, else grid by grid, or sample by sample.
void TileColors::add_found(const Shares& shares, int column, int row, ColorSum& sum) const {
  constexpr std::size_t kTogether = 6;
  const auto grid_of = [&](const Shares::Share& share) {
    SurfaceGrid grid = landings_.landing(share.pair, column, row, per_axis_);
    grid.counted = share.samples;
    return grid;
  };
  if (shares.found().size() <= kTogether) {
    std::array<SurfaceGrid, kTogether> grids;
    std::size_t count = 0;
    for (const Shares::Share& share : shares.found()) grids[count++] = grid_of(share);
    if (const auto mean = printed_.mean({grids.data(), count})) {
      const int unknown = std::popcount(shares.unknown());
      sum.add(*mean, weight() * static_cast<float>(per_axis_ * per_axis_ - unknown));
      return;
    }
  }
  for (const Shares::Share& share : shares.found()) add_grid(grid_of(share), column, row, sum);
}

void TileColors::add_grid(const SurfaceGrid& grid, int column, int row, ColorSum& sum) const {
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
std::optional<LinearColor> TileColors::beside_film(int column, int row) {
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
std::optional<SurfacePoint> TileColors::landing(const Vec2& film_mm) {
  const auto point = map_.to_object(film_mm, cursor_);
  if (point || !(bleed_mm_ > 0)) return point;
  const auto near = map_.nearest_covered(film_mm, bleed_mm_, cursor_);
  return near ? map_.to_object(*near, cursor_) : std::nullopt;
}

}  // namespace hydrodip
