// The outline, in film coordinates, of the film that lies on the object.
#pragma once

#include <optional>
#include <vector>

#include "base/cells.h"
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
  std::vector<Edge> edges_;
  Box2 covered_;
  Box2 bounds_;                                      // of the outline
  Cells cells_;                                      // over them
  std::vector<std::vector<std::int32_t>> edges_in_;  // by cell; each in all that its box touches
};

}  // namespace hydrodip
