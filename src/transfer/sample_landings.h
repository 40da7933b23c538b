// Film over the object, triangle on triangle: where every sample of a part of the film lands.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"
#include "object/object.h"
#include "transfer/film_map.h"
#include "transfer/texture_mean.h"
#include "transfer/triangle_samples.h"

namespace hydrodip {

// A triangle of film on the plane of a triangle of the object: lines from the film along its
// directions meet the plane at quotients of functions that are linear over the film.
struct FilmOnPlane {
  int object_triangle = -1;
  LinearOnGrid height, slope;     // a line's way to the plane is their quotient
  LinearOnGrid u, v;              // of the line's beginning, seen from above the plane
  LinearOnGrid u_along, v_along;  // how they change along the line

  SurfacePoint at(double column, double row) const;
};

// Where the samples of a grid land as FilmMap::to_object says: every pair of triangles is drawn
// over the samples that it holds, and of several the nearest along the line counts. Not all samples
// are found: film far from the object, or beside an edge that its lines miss, is to be asked for
// one by one.
class SampleLandings {
 public:
  static constexpr std::int32_t kNone = -1;

  // `film_triangles`: all those of FilmMap::lying() of which a part may be under the grid.
  SampleLandings(const FilmMap& map, const SampleGrid& grid,
                 const std::vector<std::int32_t>& film_triangles);

  // The pair that holds a sample, or kNone.
  std::int32_t pair_at(int column, int row) const {
    return pair_.empty() ? kNone : pair_[index(column, row)];
  }
  // Where a pair's samples land, for `per_axis` of them in each direction from one on, as if it
  // held them all.
  SurfaceGrid landing(std::int32_t pair, int column, int row, int per_axis) const;

 private:
  class Drawing;

  std::size_t index(int column, int row) const {
    return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
  }

  const int columns_;
  std::vector<FilmOnPlane> pairs_;
  std::vector<std::int32_t> pair_;  // per sample; empty: none is found
};

}  // namespace hydrodip
