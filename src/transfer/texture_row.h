// What a texture shows under a row of pixels that one triangle of film has on one of the object.
#pragma once

#include <optional>
#include <span>

#include "object/object.h"
#include "transfer/sample_landings.h"

namespace hydrodip {

// As mean_texture_color() of each pixel's samples, all of which count: lines from film to the
// texture are quotients of linear functions, and what is common to a row is computed once.
class TextureRow {
 public:
  // Refers to both. Of an object without colours at corners.
  TextureRow(const Object& object, const FilmOnPlane& pair, const LinearColor& base);

  // Of pixels side by side, `per_axis` samples in each direction, from the one whose first sample
  // is (column, row) on. Nothing where mean_texture_color() has nothing.
  void means(int column, int row, int per_axis, std::span<std::optional<LinearColor>> colors) const;

 private:
  // A coordinate of the texture: of where a line begins, and how it changes along the line.
  struct Coordinate {
    LinearOnGrid start, along;
    int texels = 0;
    bool repeats = false;
  };
  Coordinate coordinate(const CornerUv& corners, Eigen::Index axis, int texels, Wrap wrap) const;

  const Object& object_;
  const FilmOnPlane& pair_;
  const LinearColor base_;
  const Material& material_;
  const Image* image_ = nullptr;  // null: nothing but the material
  Coordinate x_, y_;
};

}  // namespace hydrodip
