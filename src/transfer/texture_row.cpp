#include "transfer/texture_row.h"

#include <array>
#include <cmath>

#include "transfer/texel_mean.h"
#include "transfer/texture_mean.h"

namespace hydrodip {
namespace {

constexpr std::size_t kAtOnce = 32;

// a f + b g + c
LinearOnGrid sum_of(double a, const LinearOnGrid& f, double b, const LinearOnGrid& g, double c) {
  return {a * f.first + b * g.first + c, a * f.across + b * g.across, a * f.down + b * g.down};
}

// A linear function in a row.
struct AlongRow {
  double start, across;
  AlongRow(const LinearOnGrid& f, int row) : start(f.first + row * f.down), across(f.across) {}
  double at(double column) const { return start + column * across; }
};

using PerPixel = std::array<double, kAtOnce>;

// Lines' ways to the plane, from every so many samples of a row on.
void find_ways(const FilmOnPlane& pair, double column, int row, int step, std::size_t count,
               PerPixel& ways) {
  const AlongRow height(pair.height, row), slope(pair.slope, row);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = column + double(int(i) * step);
    ways[i] = height.at(at) / slope.at(at);
  }
}

}  // namespace

TextureRow::TextureRow(const Object& object, const FilmOnPlane& pair, const LinearColor& base)
    : object_(object),
      pair_(pair),
      base_(base),
      material_(
          object.materials[std::size_t(object.material_of[std::size_t(pair.object_triangle)])]) {
  if (material_.texture < 0 || object.uvs.empty()) return;
  image_ = object.textures[std::size_t(material_.texture)].get();
  const CornerUv& corners = object.uvs[std::size_t(pair.object_triangle)];
  x_ = coordinate(corners, 0, image_->width_px, material_.wrap_u);
  y_ = coordinate(corners, 1, image_->height_px, material_.wrap_v);
}

TextureRow::Coordinate TextureRow::coordinate(const CornerUv& corners, Eigen::Index axis,
                                              int texels, Wrap wrap) const {
  const double origin = double(corners[0][axis]);
  const double along_u = double(corners[1][axis]) - origin;
  const double along_v = double(corners[2][axis]) - origin;
  return {sum_of(along_u, pair_.u, along_v, pair_.v, origin),
          sum_of(along_u, pair_.u_along, along_v, pair_.v_along, 0), texels, wrap == Wrap::kRepeat};
}

void TextureRow::means(int column, int row, int per_axis,
                       std::span<std::optional<LinearColor>> colors) const {
  if (image_ == nullptr) {
    for (auto& color : colors) color = color_at(object_, pair_.at(column, row), base_);
    return;
  }
  while (colors.size() > kAtOnce) {
    means(column, row, per_axis, colors.first(kAtOnce));
    colors = colors.subspan(kAtOnce);
    column += int(kAtOnce) * per_axis;
  }
  PerPixel here, right, below;
  find_ways(pair_, column, row, per_axis, colors.size(), here);
  find_ways(pair_, column + 1, row, per_axis, colors.size(), right);
  find_ways(pair_, column, row + 1, per_axis, colors.size(), below);
  std::array<TexelsAlong, kAtOnce> x, y;
  const auto texels = [&](const Coordinate& of, std::array<TexelsAlong, kAtOnce>& along) {
    const AlongRow start(of.start, row), rate(of.along, row);
    const AlongRow start_below(of.start, row + 1), rate_below(of.along, row + 1);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const double at = column + double(int(i) * per_axis);
      double first = start.at(at) + here[i] * rate.at(at);
      const double across = start.at(at + 1) + right[i] * rate.at(at + 1) - first;
      const double down = start_below.at(at) + below[i] * rate_below.at(at) - first;
      if (of.repeats && !(first >= 0 && first < 1)) first -= std::floor(first);
      along[i] = {float(first * of.texels - 0.5), float(across * of.texels),
                  float(down * of.texels)};
    }
  };
  texels(x_, x);
  texels(y_, y);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    colors[i] = mean_of_texels(*image_, x[i], y[i], per_axis);
    if (colors[i]) colors[i] = over_base(*colors[i], material_.base_color, base_);
  }
}

}  // namespace hydrodip
