#include "transfer/sample_landings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hydrodip {
namespace {

// Lines that meet a plane flatter than that may leave it within a triangle of film.
constexpr double kFlattest = 0.05;

using AtCorners = std::array<double, 3>;

double least_of(const AtCorners& values) { return std::min({values[0], values[1], values[2]}); }
double most_of(const AtCorners& values) { return std::max({values[0], values[1], values[2]}); }

// How far film may be from the object where its corners touch it: by as much as their directions
// say that it is curved, and some more.
double gap_of(const LyingTriangle& film) {
  double size = 0, bulge = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const Vec3 side = film.position[l] - film.position[k];
    size = std::max(size, side.norm());
    bulge = std::max(
        {bulge, std::abs(side.dot(film.direction[k])), std::abs(side.dot(film.direction[l]))});
  }
  return 0.1 * size + 0.5 * bulge;
}

// What of the object a triangle of film may land on.
class Surroundings {
 public:
  Surroundings(const LyingTriangle& film, double gap_mm) {
    const auto& [a, b, c] = film.position;
    middle_ = (a + b + c) / 3;
    least_ = a.cwiseMin(b).cwiseMin(c).array() - gap_mm;
    most_ = a.cwiseMax(b).cwiseMax(c).array() + gap_mm;
    for (const Vec3& corner : film.position)
      radius_mm_ = std::max(radius_mm_, (corner - middle_).norm() + gap_mm);
    find_walls(film, gap_mm);
  }

  // In place of what was in `triangles`.
  void find(const FilmMap& map, std::vector<int>& triangles) const {
    map.surface().triangles_near(middle_, radius_mm_, triangles);
    std::erase_if(triangles, [&](int triangle) { return !may_hold(map.object(), triangle); });
    // Of those that are equally near along a line the first counts.
    std::sort(triangles.begin(), triangles.end());
  }

 private:
  bool may_hold(const TriangleMesh& object, int triangle) const {
    const Triangle& t = object.triangles[std::size_t(triangle)];
    const Vec3 &a = object.positions[std::size_t(t[0])], &b = object.positions[std::size_t(t[1])],
               &c = object.positions[std::size_t(t[2])];
    return (a.cwiseMin(b).cwiseMin(c).array() <= most_.array()).all() &&
           (a.cwiseMax(b).cwiseMax(c).array() >= least_.array()).all() &&
           std::none_of(walls_.begin(), walls_.end(), [&](const Wall& wall) {
             return wall.outside(a) && wall.outside(b) && wall.outside(c);
           });
  }

  // Through the film triangle's sides, as far out as lines lean within the gap.
  void find_walls(const LyingTriangle& film, double gap_mm) {
    const auto& [a, b, c] = film.position;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const double side = film.direction[0].dot(normal) < 0 ? -1 : 1;
    double lean = 0;
    for (const Vec3& direction : film.direction) {
      const double along = side * direction.dot(normal);
      if (!(along > kFlattest)) return;
      lean = std::max(lean, direction.cross(normal).norm() / along);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = film.position[k];
      const Vec3 out = (film.position[(k + 1) % 3] - corner).cross(normal).normalized();
      walls_.push_back({out, out.dot(corner) + lean * gap_mm + 1e-9});
    }
  }

  struct Wall {
    Vec3 out;
    double from;
    bool outside(const Vec3& point) const { return out.dot(point) > from; }
  };

  double radius_mm_ = 0;
  Vec3 middle_, least_, most_;
  std::vector<Wall> walls_;
};

// Of a triangle of film, where its corners land in the plane of one of the object's.
struct CornersOnPlane {
  AtCorners height, slope, u, v, u_along, v_along;
  bool exists = false;  // of a triangle without area there is no plane

  CornersOnPlane(const LyingTriangle& film, const TriangleMesh& object, int triangle) {
    const Triangle& t = object.triangles[std::size_t(triangle)];
    const Vec3& corner = object.positions[std::size_t(t[0])];
    const Vec3 e1 = object.positions[std::size_t(t[1])] - corner;
    const Vec3 e2 = object.positions[std::size_t(t[2])] - corner;
    const Vec3 normal = e1.cross(e2);
    const double squared = normal.squaredNorm();
    exists = squared > 0;
    if (!exists) return;
    const double per_squared = 1 / squared, per_length = 1 / std::sqrt(squared);
    const Vec3 unit = normal * per_length;
    const Vec3 to_u = e2.cross(normal) * per_squared, to_v = normal.cross(e1) * per_squared;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 from = film.position[k] - corner;
      const Vec3& along = film.direction[k];
      height[k] = -from.dot(unit);
      slope[k] = along.dot(unit);
      u[k] = from.dot(to_u);
      v[k] = from.dot(to_v);
      u_along[k] = along.dot(to_u);
      v_along[k] = along.dot(to_v);
    }
  }
};

// What a quotient of linear functions is at corners, and how far it may be from linear between
// them.
struct NearlyLinear {
  AtCorners value;
  double slack = 0;

  template <class At>
  explicit NearlyLinear(const At& at) {
    for (std::size_t k = 0; k < 3; ++k) value[k] = at(k, k);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      slack = std::max(slack, std::abs(at(k, l) - 0.5 * (value[k] + value[l])));
    }
    slack = 2 * slack + 1e-9;
  }
  AtCorners plus_slack() const { return {value[0] + slack, value[1] + slack, value[2] + slack}; }
};

// Where a pair's samples may be.
struct Limits {
  std::vector<HalfPlane> sides;
  bool none_inside = false;

  Limits(const CornersOnPlane& on, const TriangleSamples& samples, double most_gap_mm) {
    const double least = least_of(on.slope), most = most_of(on.slope);
    if (!(least > kFlattest || most < -kFlattest)) return;  // anywhere
    const auto between = [](const AtCorners& values, std::size_t k, std::size_t l) {
      return 0.5 * (values[k] + values[l]);
    };
    const auto way = [&](std::size_t k, std::size_t l) {
      return between(on.height, k, l) / between(on.slope, k, l);
    };
    const NearlyLinear way_mm(way);
    const NearlyLinear u([&](std::size_t k, std::size_t l) {
      return between(on.u, k, l) + way(k, l) * between(on.u_along, k, l);
    });
    const NearlyLinear v([&](std::size_t k, std::size_t l) {
      return between(on.v, k, l) + way(k, l) * between(on.v_along, k, l);
    });
    AtCorners rest;
    for (std::size_t k = 0; k < 3; ++k) rest[k] = 1 - u.value[k] - v.value[k] + u.slack + v.slack;
    const double gap_mm = most_gap_mm + way_mm.slack;
    none_inside = most_of(u.plus_slack()) < 0 || most_of(v.plus_slack()) < 0 || most_of(rest) < 0 ||
                  least_of(way_mm.value) > gap_mm || most_of(way_mm.value) < -gap_mm;
    if (none_inside) return;
    for (const AtCorners& corners : {u.plus_slack(), v.plus_slack(), rest})
      if (least_of(corners) < 0) sides.emplace_back(samples.linear(corners));
  }
};

// The same in floats, one row of samples after the other.
struct RowFunction {
  float start, across;
  RowFunction(const LinearOnGrid& function, int row)
      : start(float(function.first + row * function.down)), across(float(function.across)) {}
  float at(float column) const { return start + column * across; }
};

}  // namespace

SurfacePoint FilmOnPlane::at(double column, double row) const {
  const double way = height.at(column, row) / slope.at(column, row);
  return {object_triangle, u.at(column, row) + way * u_along.at(column, row),
          v.at(column, row) + way * v_along.at(column, row)};
}

// Draws pairs; of those that hold a sample, the nearest stays.
class SampleLandings::Drawing {
 public:
  Drawing(SampleLandings& landings, const FilmMap& map, const SampleGrid& grid)
      : landings_(landings), map_(map), grid_(grid) {}

  void draw(const LyingTriangle& film) {
    const TriangleSamples samples(film, grid_);
    if (samples.empty()) return;
    gap_mm_ = std::min(gap_of(film), map_.reach_mm());
    Surroundings(film, gap_mm_).find(map_, near_);
    for (const int triangle : near_) draw(film, samples, triangle);
  }

 private:
  void draw(const LyingTriangle& film, const TriangleSamples& samples, int object_triangle) {
    const CornersOnPlane on(film, map_.object(), object_triangle);
    if (!on.exists) return;
    const Limits limits(on, samples, gap_mm_);
    if (limits.none_inside) return;
    Span rows = samples.rows();
    for (const HalfPlane& side : limits.sides) rows = side.rows(rows, samples.columns());
    if (rows.empty()) return;
    const FilmOnPlane pair{object_triangle,           samples.linear(on.height),
                           samples.linear(on.slope),  samples.linear(on.u),
                           samples.linear(on.v),      samples.linear(on.u_along),
                           samples.linear(on.v_along)};
    bool any = false;
    for (int row = rows.begin; row < rows.end; ++row) {
      Span span = samples.in_row(row);
      for (const HalfPlane& side : limits.sides) span = side.in_row(row, span);
      if (!span.empty()) any |= draw_row(pair, row, span);
    }
    if (any) landings_.pairs_.push_back(pair);
  }

  bool draw_row(const FilmOnPlane& pair, int row, const Span& span) {
    if (way_.empty()) begin();
    const RowFunction height(pair.height, row), slope(pair.slope, row), u(pair.u, row),
        v(pair.v, row), u_along(pair.u_along, row), v_along(pair.v_along, row);
    const auto gap_mm = float(gap_mm_);
    const auto number = std::int32_t(landings_.pairs_.size());
    float* way_mm = way_.data() + landings_.index(0, row);
    std::int32_t* pair_at = landings_.pair_.data() + landings_.index(0, row);
    std::int32_t any = 0;
    for (int column = span.begin; column < span.end; ++column) {
      const auto x = float(column);
      const float way = height.at(x) / slope.at(x), distance = std::abs(way);
      const float at_u = u.at(x) + way * u_along.at(x), at_v = v.at(x) + way * v_along.at(x);
      const bool nearer = (at_u >= 0) & (at_v >= 0) & (at_u + at_v <= 1) & (distance <= gap_mm) &
                          (distance < way_mm[column]);
      way_mm[column] = nearer ? distance : way_mm[column];
      pair_at[column] = nearer ? number : pair_at[column];
      any |= nearer;
    }
    return any != 0;
  }

  void begin() {
    const std::size_t samples = std::size_t(grid_.columns) * std::size_t(grid_.rows);
    way_.assign(samples, std::numeric_limits<float>::infinity());
    landings_.pair_.assign(samples, kNone);
  }

  SampleLandings& landings_;
  const FilmMap& map_;
  const SampleGrid& grid_;
  double gap_mm_ = 0;       // that film is at most from what it is drawn on
  std::vector<int> near_;   // triangles of the object
  std::vector<float> way_;  // per sample, to where the nearest pair has it land
};

SampleLandings::SampleLandings(const FilmMap& map, const SampleGrid& grid,
                               const std::vector<std::int32_t>& film_triangles)
    : columns_(grid.columns) {
  Drawing drawing(*this, map, grid);
  for (const std::int32_t triangle : film_triangles) drawing.draw(map.lying(triangle));
}

SurfaceGrid SampleLandings::landing(std::int32_t pair, int column, int row, int per_axis) const {
  const FilmOnPlane& on = pairs_[std::size_t(pair)];
  const SurfacePoint right = on.at(column + 1, row), below = on.at(column, row + 1);
  SurfaceGrid grid;
  grid.per_axis = per_axis;
  grid.first = on.at(column, row);
  grid.u_across = right.u - grid.first.u;
  grid.v_across = right.v - grid.first.v;
  grid.u_down = below.u - grid.first.u;
  grid.v_down = below.v - grid.first.v;
  return grid;
}

}  // namespace hydrodip
