// The waterline: where the water surface cuts the object, seen from above, moment by moment.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/cells.h"
#include "base/math.h"
#include "dip/travel.h"

namespace hydrodip {

// Steepness that stands for a vertical wall.
constexpr double kWall = 1e6;

// Segments of the object's cross-section in the water plane, in the sinking frame, with a grid over
// them for local queries. Needs no connectivity: any set of triangles has a waterline, even if it
// is not closed.
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

  // Cuts at a new moment. Costs in proportion to the triangles near the water, as long as the
  // object moves little from call to call, and once in a while a little of all.
  void move_to(const Moment& to);

  // Where the straight way from `from` to `to` leaves the object first.
  std::optional<Point> exit(const Vec2& from, const Vec2& to) const;

  // Closest point of the waterline.
  std::optional<Point> closest(const Vec2& point, double max_distance) const;

  bool empty() const { return segments_.empty(); }

  // Whether a point that goes from a to b in the water plane, from the last moment but one to the
  // last, may touch the object. False only if it certainly does not.
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
  // A triangle and what it reaches, seen from above.
  struct Reach {
    std::int32_t triangle;
    Box2 box;
    CellRange cells;  // of the grid over the whole object
  };
  void cover(const Box2& plan);
  void mark(const Reach& reach);
  void cut(const std::array<const Vec3*, 3>& corners, double level);

  // While the object neither shifts nor turns, the water rises through triangles that are sorted.
  void rise_to(double level);
  void sort_by_bottom();

  // Else those near the water are gathered once in a while.
  struct Near {
    std::int32_t triangle;
    double bottom, top;  // when they were, in the sinking frame
  };
  // How much higher above the water the object's points are than then: least and most.
  struct Change {
    double least = 0, most = 0;
  };
  void pass(const Moment& to);
  Change change_since_gathered(const Moment& to) const;
  void gather(const Moment& to);
  using Corners = std::array<Vec3, 3>;  // in the sinking frame
  Corners corners_of(std::int32_t triangle, const Moment& moment) const;

  void build_grid();

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& triangles_;
  double cell_;
  Box3 box_;  // the object's

  std::vector<std::int32_t> by_bottom_;  // triangles by lowest corner
  std::size_t next_ = 0;                 // first of by_bottom_ that is still above the water
  std::vector<Reach> active_;            // triangles that reach from below to above the level

  std::vector<Box3> runs_;  // around triangles that follow each other
  // Triangles that may come to the water until the height of some point has changed by more than
  // the margin since they were gathered.
  std::vector<Near> near_;
  std::optional<Moment> gathered_, now_;
  double margin_ = 0;
  Change change_;  // now

  // Cells over the whole object that triangles at the water between the last two moments reach:
  // those with the present number. The box is around all of them.
  Cells whole_;
  Box2 swept_;
  std::vector<std::uint32_t> reached_;
  std::uint32_t moves_ = 0;
  std::vector<Segment> segments_;
  Cells grid_;  // over the segments
  std::vector<std::int32_t> grid_begin_;
  std::vector<std::int32_t> grid_items_;
};

}  // namespace hydrodip
