// What a texture shows on average where a pixel's samples land.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>

#include "object/object.h"

namespace hydrodip {

// Points of one triangle's plane in even rows and columns: where the samples of a pixel land.
struct SurfaceGrid {
  static constexpr int kMostPerAxis = 8;
  SurfacePoint first;
  double u_across = 0, v_across = 0;  // from one to the next in its row
  double u_down = 0, v_down = 0;      // and in its column
  int per_axis = 1;                   // so many in each row and column, at most kMostPerAxis
  // Those that count, a bit for each, the lowest for the first, row by row: others land elsewhere.
  std::uint64_t counted = ~std::uint64_t(0);

  bool counts(int column, int row) const {
    return (counted >> (row * per_axis + column) & 1U) != 0;
  }
  int count() const {
    const int all = per_axis * per_axis;
    return std::popcount(all < 64 ? counted & ((std::uint64_t(1) << all) - 1) : counted);
  }
  SurfacePoint at(double column, double row) const {
    return {first.triangle, first.u + column * u_across + row * u_down,
            first.v + column * v_across + row * v_down};
  }
};

// The mean of color_at over the grid's points that count, as closely as floats tell, where colours
// come from a texture alone, whose few texels under the grid lie in its inside, or from nothing but
// the material. Else nothing.
std::optional<LinearColor> mean_texture_color(const Object& object, const SurfaceGrid& grid,
                                              const LinearColor& base);

}  // namespace hydrodip
