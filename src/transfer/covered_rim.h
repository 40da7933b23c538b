// The outline, in film coordinates, of the film that lies on the object.
#pragma once

#include <optional>
#include <vector>

#include "film/film.h"

namespace hydrodip {

class CoveredRim {
 public:
  explicit CoveredRim(const DippedFilm& film);

  // Bounds of the covered film; empty if there is none.
  const Box2& covered() const { return covered_; }

  // Nearest point of the outline within max_distance, moved into the covered film by a hair so
  // that looking it up finds film.
  std::optional<Vec2> nearest(const Vec2& u, double max_distance) const;

 private:
  struct Edge {
    Vec2 a, b;
    Vec2 inside;  // centroid of the covered triangle at this edge
  };
  // visit(number) for the buckets that touch a box, or the nearest to it.
  template <class Visit>
  void for_buckets(const Vec2& min, const Vec2& max, const Visit& visit) const;

  std::vector<Edge> edges_;
  Box2 covered_;
  // Uniform buckets over the outline's bounds; each edge is in all that its box touches.
  Box2 bounds_;
  double cell_ = 1;
  int nx_ = 0, ny_ = 0;
  std::vector<std::vector<std::int32_t>> buckets_;
};

}  // namespace hydrodip
