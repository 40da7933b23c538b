// What a picture shows on average, bilinear between its texels, at a pixel's samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "image/image.h"

namespace hydrodip {

// A coordinate along one axis of a picture, in texels from the centre of the first one (along y
// from the lowest row up), of points in even rows and columns.
struct TexelsAlong {
  float first = 0, across = 0, down = 0;  // of the first point, and from one to the next

  float at(int column, int row) const { return first + float(column) * across + float(row) * down; }
  float least(int last) const {
    return first + float(last) * (std::min(across, 0.0F) + std::min(down, 0.0F));
  }
  float most(int last) const {
    return first + float(last) * (std::max(across, 0.0F) + std::max(down, 0.0F));
  }
};

// Points on a picture, and how far they go.
class TexelPoints {
 public:
  static constexpr std::size_t kMost = 64;

  // Those of `per_axis` squared points that count, as in SurfaceGrid::counted.
  void add(const TexelsAlong& x, const TexelsAlong& y, int per_axis, std::uint64_t counted);

  std::size_t count() const { return count_; }
  const std::array<float, kMost>& x() const { return x_; }
  const std::array<float, kMost>& y() const { return y_; }
  // Limits.
  float least_x() const { return least_x_; }
  float most_x() const { return most_x_; }
  float least_y() const { return least_y_; }
  float most_y() const { return most_y_; }

 private:
  std::array<float, kMost> x_, y_;
  std::size_t count_ = 0;
  float least_x_ = 1e30F, most_x_ = -1e30F, least_y_ = 1e30F, most_y_ = -1e30F;
};

// Colours are weighted by their alpha, and premultiplied. Nothing if some points lie beyond the
// picture, or if they lie among many texels. Points that are nowhere have no mean.
std::optional<LinearColor> mean_of_texels(const Image& image, const TexelPoints& points);

// The same of all `per_axis` squared points.
std::optional<LinearColor> mean_of_texels(const Image& image, const TexelsAlong& x,
                                          const TexelsAlong& y, int per_axis);

}  // namespace hydrodip
