// Where the samples of a pixel land, told by where its corners do: film and object are flat
// triangles, so that between corners on the same ones nothing needs to be looked up.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "transfer/film_map.h"
#include "transfer/texture_mean.h"

namespace hydrodip {

// Where a corner of a pixel lands.
struct PixelCorner {
  Vec2 film_mm;
  std::int32_t film_triangle;
  FilmMap::Laid laid;  // in that triangle
  SurfacePoint point;
};

// Upper left, upper right, lower left, lower right.
using PixelCorners = std::array<const PixelCorner*, 4>;

// Whether all corners lie in the same triangle of the film and land on the same of the object.
bool on_one_pair(const PixelCorners& corners);

// Where the samples of a pixel land if all corners are of one pair. Samples lie on a regular grid
// inside the pixel, `per_axis` in each row.
SurfaceGrid grid_between(const PixelCorners& corners, int per_axis);

// A pixel that several triangles share: each pair of a film's and an object's triangle among those
// at its corners is extended over the whole pixel, and every sample lies in the one that has it; in
// a valley of the object two may, then in the nearer one. At most SurfaceGrid::kMostPerAxis
// samples in a row.
class SharedPixel {
 public:
  SharedPixel(const FilmMap& map, const PixelCorners& corners, int per_axis);

  // Of the pairs that have samples: where these land. Some may have lost theirs to a nearer pair.
  std::span<const SurfaceGrid> grids() const { return {grids_.data(), grids_count_}; }
  // The samples that none has, as SurfaceGrid::counted.
  std::uint64_t unknown() const { return unknown_; }

 private:
  struct Film {
    std::int32_t triangle;
    std::array<FilmMap::Laid, 4> laid;  // at the pixel's corners
  };
  struct Samples;

  void find_films();
  void take(const Film& film, int object_triangle, Samples& samples);
  void group(const Samples& samples);

  const FilmMap& map_;
  const PixelCorners& corners_;
  const int per_axis_;
  std::array<Film, 4> films_;
  std::size_t films_count_ = 0;
  std::array<SurfaceGrid, 16> grids_;
  std::size_t grids_count_ = 0;
  std::uint64_t unknown_ = 0;
};

}  // namespace hydrodip
