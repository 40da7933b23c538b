// Film coordinates in which film that a dip has stretched is flat and whole again: a pattern drawn
// in them looks unstretched on the object.
#pragma once

#include <vector>

#include "film/film.h"

namespace hydrodip {

class FlatFilm {
 public:
  // As rigid as possible (Liu and others, "A local/global approach to mesh parameterization",
  // 2008), from the film on the object; what lies elsewhere follows. Throws Cancelled.
  explicit FlatFilm(const DippedFilm& film);

  // For a point of the film as printed, mm.
  Vec2 at(const Vec2& film_mm) const;

  // How far lengths on the object are from those of a pattern: stretch - 1, root mean square by
  // area.
  double distortion() const { return distortion_; }  // drawn in these coordinates
  double distortion_as_printed() const { return distortion_as_printed_; }

 private:
  SharedFilmMesh mesh_;
  std::vector<Vec2> place_;  // per vertex
  double distortion_ = 0, distortion_as_printed_ = 0;
};

}  // namespace hydrodip
