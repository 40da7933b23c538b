#include "transfer/tile_colors.h"

#include <array>
#include <bit>
#include <span>

#include "transfer/color_sum.h"

namespace hydrodip {

SampleGrid samples_of(const Tile& tile, const SheetRaster& raster, int per_axis) {
  const double step_px = 1.0 / per_axis;
  return {raster.to_film(tile.x0 + 0.5 * step_px, tile.y0 + 0.5 * step_px),
          kMmPerInch / raster.dpi * step_px, (tile.x1 - tile.x0) * per_axis,
          (tile.y1 - tile.y0) * per_axis};
}

namespace {

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

}  // namespace

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

LinearColor TileColors::of_pixel(int x, int y) {
  const int column = (x - tile_.x0) * per_axis_, row = (y - tile_.y0) * per_axis_;
  const PixelShares shares(landings_, column, row, per_axis_);
  if (shares.found().empty())
    if (const auto color = beside_film(column, row)) return *color;
  const float weight = 1.0F / static_cast<float>(per_axis_ * per_axis_);
  ColorSum sum;
  for (const auto& [pair, samples] : shares.found()) {
    SurfaceGrid grid = landings_.landing(pair, column, row, per_axis_);
    grid.counted = samples;
    const LinearColor mean =
        printed_.mean(grid, [&](int i, int j) { return samples_.at(column + i, row + j); });
    if (shares.found().size() == 1 && shares.unknown() == 0) return mean;
    sum.add(mean, weight * static_cast<float>(grid.count()));
  }
  for (std::uint64_t left = shares.unknown(); left != 0; left &= left - 1) {
    const int sample = std::countr_zero(left);
    const int i = sample % per_axis_, j = sample / per_axis_;
    const Vec2 film_mm = samples_.at(column + i, row + j);
    if (const auto point = landing(film_mm)) sum.add(printed_.at(*point, film_mm), weight);
  }
  return sum.color();
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
