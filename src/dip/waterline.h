// The waterline: where the water surface cuts the object, seen from above, as the water rises.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/cells.h"
#include "base/math.h"

namespace hydrodip {

// Segments of the object's cross-section at one level, with a grid over them for local queries.
// Needs no connectivity: any set of triangles has a waterline, even if it is not closed.
class Waterline {
 public:
  struct Point {
    Vec2 position;
    Vec2 outward;      // unit, away from the object, normal to the waterline
    double steepness;  // rise of the surface over outward run: dz = steepness * run; may be < 0
  };

  // Keeps references. cell_mm: spacing of the query grid, about the size of the queries.
  Waterline(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
            double cell_mm);

  // Cuts at a new level, not below the last one. Costs in proportion to the triangles at it.
  void raise_to(double level);

  // Where the straight way from `from` to `to` leaves the object first.
  std::optional<Point> exit(const Vec2& from, const Vec2& to) const;

  // Closest point of the waterline.
  std::optional<Point> closest(const Vec2& point, double max_distance) const;

  bool empty() const { return segments_.empty(); }

  // Whether a point that goes from a to b, seen from above, while the water rises from the last
  // level but one to the last, may touch the object. False only if it certainly does not.
  bool may_touch(const Vec2& a, const Vec2& b) const;

 private:
  struct Segment {
    Vec2 a, b;
    Vec2 outward;
    double steepness;
    CellRange cells;  // of the grid, that it is listed in
  };
  template <class Weight>
  Point blurred(const Point& point, const Weight& weight_of) const;
  void sweep();
  struct Reach {
    std::int32_t triangle;
    Box2 box;         // seen from above
    CellRange cells;  // that it touches, of the grid over the whole object
  };
  Reach reach_of(std::int32_t triangle) const;
  void mark(const Reach& reach);
  void cut(std::int32_t triangle);
  void build_grid();

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  double cell_;
  double level_ = -1e300;
  // Cells over the whole object that triangles between the last two levels reach: those with the
  // present number. The box is around all of them.
  Cells whole_;
  Box2 swept_;
  std::vector<std::uint32_t> reached_;
  std::uint32_t raises_ = 0;
  std::vector<std::int32_t> by_bottom_;  // triangles by lowest corner
  std::size_t next_ = 0;                 // first of by_bottom_ that is still above the water
  std::vector<Reach> active_;            // triangles that reach from below to above the level
  std::vector<Segment> segments_;
  Cells grid_;  // over the segments
  std::vector<std::int32_t> grid_begin_;
  std::vector<std::int32_t> grid_items_;
};

}  // namespace hydrodip
