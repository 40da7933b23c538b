#include "transfer/shared_pixel.h"

#include <algorithm>
#include <limits>

namespace hydrodip {
namespace {

constexpr double kInside = -1e-9;
constexpr std::size_t kMostSamples =
    std::size_t(SurfaceGrid::kMostPerAxis) * std::size_t(SurfaceGrid::kMostPerAxis);
constexpr std::uint8_t kNone = 255;

// A function over a pixel by its values in the corners; 0 <= x, y <= 1 from the upper left one.
class Bilinear {
 public:
  template <class At>
  explicit Bilinear(const At& at)
      : corner_(at(0)),
        across_(at(1) - corner_),
        down_(at(2) - corner_),
        twist_(at(3) - at(2) - across_) {}

  struct Row {
    double first, across;
    double at(double x) const { return first + across * x; }
  };
  Row row(double y) const { return {corner_ + down_ * y, across_ + twist_ * y}; }
  double at(double x, double y) const { return row(y).at(x); }

 private:
  double corner_, across_, down_, twist_;
};

SurfaceGrid grid_of(int triangle, const Bilinear& u, const Bilinear& v, int per_axis) {
  const double step = 1.0 / per_axis, first = 0.5 * step;
  SurfaceGrid grid;
  grid.per_axis = per_axis;
  grid.first = {triangle, u.at(first, first), v.at(first, first)};
  grid.u_across = u.at(first + step, first) - grid.first.u;
  grid.v_across = v.at(first + step, first) - grid.first.v;
  grid.u_down = u.at(first, first + step) - grid.first.u;
  grid.v_down = v.at(first, first + step) - grid.first.v;
  return grid;
}

}  // namespace

bool on_one_pair(const PixelCorners& corners) {
  return std::all_of(corners.begin(), corners.end(), [&](const PixelCorner* corner) {
    return corner->film_triangle == corners[0]->film_triangle &&
           corner->point.triangle == corners[0]->point.triangle;
  });
}

SurfaceGrid grid_between(const PixelCorners& corners, int per_axis) {
  return grid_of(corners[0]->point.triangle,
                 Bilinear([&](std::size_t k) { return corners[k]->point.u; }),
                 Bilinear([&](std::size_t k) { return corners[k]->point.v; }), per_axis);
}

// Which of the grids has each sample, row by row, and how far it is from there.
struct SharedPixel::Samples {
  std::array<std::uint8_t, kMostSamples> grid;
  std::array<double, kMostSamples> distance_mm;

  explicit Samples(std::size_t count) {
    std::fill_n(grid.begin(), count, kNone);
    std::fill_n(distance_mm.begin(), count, std::numeric_limits<double>::infinity());
  }
};

SharedPixel::SharedPixel(const FilmMap& map, const PixelCorners& corners, int per_axis)
    : map_(map), corners_(corners), per_axis_(per_axis) {
  Samples samples(std::size_t(per_axis) * std::size_t(per_axis));
  find_films();
  for (std::size_t k = 0; k < 4; ++k) {
    const int object_triangle = corners[k]->point.triangle;
    const bool taken =
        std::any_of(corners.begin(), corners.begin() + std::ptrdiff_t(k),
                    [&](const auto* before) { return before->point.triangle == object_triangle; });
    for (std::size_t film = 0; film < films_count_ && !taken; ++film)
      take(films_[film], object_triangle, samples);
  }
  group(samples);
}

void SharedPixel::find_films() {
  for (const PixelCorner* corner : corners_) {
    const std::int32_t triangle = corner->film_triangle;
    if (std::any_of(films_.begin(), films_.begin() + std::ptrdiff_t(films_count_),
                    [&](const Film& film) { return film.triangle == triangle; }))
      continue;
    Film& film = films_[films_count_++];
    film.triangle = triangle;
    for (std::size_t k = 0; k < 4; ++k)
      film.laid[k] = corners_[k]->film_triangle == triangle
                         ? corners_[k]->laid
                         : map_.laid(corners_[k]->film_mm, triangle);
  }
}

// The samples that land in this pair of triangles, and nearer than in those before.
void SharedPixel::take(const Film& film, int object_triangle, Samples& samples) {
  std::array<FilmMap::Projection, 4> landing;
  if (!map_.onto(object_triangle, film.laid, landing)) return;
  const Bilinear u([&](std::size_t k) { return landing[k].point.u; });
  const Bilinear v([&](std::size_t k) { return landing[k].point.v; });
  const Bilinear distance([&](std::size_t k) { return landing[k].distance_mm; });
  const Bilinear weight_1([&](std::size_t k) { return film.laid[k].weight[1]; });
  const Bilinear weight_2([&](std::size_t k) { return film.laid[k].weight[2]; });
  const auto grid = std::uint8_t(grids_count_);
  bool any = false;
  std::size_t sample = 0;
  for (int row = 0; row < per_axis_; ++row) {
    const double y = (row + 0.5) / per_axis_;
    const auto row_u = u.row(y), row_v = v.row(y), row_mm = distance.row(y);
    const auto row_1 = weight_1.row(y), row_2 = weight_2.row(y);
    for (int column = 0; column < per_axis_; ++column, ++sample) {
      const double x = (column + 0.5) / per_axis_;
      const double at_u = row_u.at(x), at_v = row_v.at(x);
      if (at_u < 0 || at_v < 0 || at_u + at_v > 1) continue;
      const double at_1 = row_1.at(x), at_2 = row_2.at(x);
      if (at_1 < kInside || at_2 < kInside || 1 - at_1 - at_2 < kInside) continue;
      const double distance_mm = row_mm.at(x);
      if (distance_mm >= samples.distance_mm[sample]) continue;
      samples.distance_mm[sample] = distance_mm;
      samples.grid[sample] = grid;
      any = true;
    }
  }
  if (any) grids_[grids_count_++] = grid_of(object_triangle, u, v, per_axis_);
}

void SharedPixel::group(const Samples& samples) {
  for (std::size_t n = 0; n < grids_count_; ++n) grids_[n].counted = 0;
  const int count = per_axis_ * per_axis_;
  for (int sample = 0; sample < count; ++sample) {
    const std::uint8_t grid = samples.grid[std::size_t(sample)];
    (grid == kNone ? unknown_ : grids_[std::size_t(grid)].counted) |= std::uint64_t(1) << sample;
  }
}

}  // namespace hydrodip
