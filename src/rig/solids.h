// Watertight solids for what is printed for the bench. Both kinds share every edge between exactly
// two triangles by the way they are made.
#pragma once

#include <functional>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// Boxes added, cut away and kept, one after another: what is in it at a point is decided by the
// last of them that says something. Exact; faces lie on the boxes' planes.
class BoxSolid {
 public:
  void add(const Vec3& min, const Vec3& max) { steps_.push_back({Kind::kAdd, min, max}); }
  void cut(const Vec3& min, const Vec3& max) { steps_.push_back({Kind::kCut, min, max}); }
  void keep(const Vec3& min, const Vec3& max) { steps_.push_back({Kind::kKeep, min, max}); }

  bool holds(const Vec3& point) const;
  TriangleMesh mesh() const;

 private:
  enum class Kind { kAdd, kCut, kKeep };
  struct Step {
    Kind kind;
    Vec3 min, max;
  };
  std::vector<Step> steps_;
};

// What lies between a lower and an upper height over cells of a grid; its lines ascend. `low` and
// `high` are asked at the lines' crossings, `is_there` at the middles of cells. high is above low
// wherever a cell is there, and cells that touch at a corner alone do not occur.
struct HeightSolid {
  std::vector<double> x, y;
  std::function<double(std::size_t i, std::size_t j)> low, high;
  std::function<bool(const Vec2& middle)> is_there;

  TriangleMesh mesh() const;
};

}  // namespace hydrodip
