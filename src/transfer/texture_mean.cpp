#include "transfer/texture_mean.h"

#include <algorithm>
#include <cmath>

#include "transfer/texel_mean.h"

namespace hydrodip {
namespace {

TexelsAlong along(const CornerUv& corners, Eigen::Index axis, const SurfaceGrid& grid, int size,
                  Wrap wrap) {
  const double origin = double(corners[0][axis]);
  const double along_u = double(corners[1][axis]) - origin;
  const double along_v = double(corners[2][axis]) - origin;
  double first = origin + grid.first.u * along_u + grid.first.v * along_v;
  if (wrap == Wrap::kRepeat) first -= std::floor(first);
  return {float(first * size - 0.5),
          float((grid.u_across * along_u + grid.v_across * along_v) * size),
          float((grid.u_down * along_u + grid.v_down * along_v) * size)};
}

}  // namespace

LinearColor over_base(const LinearColor& mean, const LinearColor& tint, const LinearColor& base) {
  const float rest = 1 - mean.a * tint.a;
  return {mean.r * tint.r * tint.a + rest * base.r, mean.g * tint.g * tint.a + rest * base.g,
          mean.b * tint.b * tint.a + rest * base.b, 1};
}

std::optional<LinearColor> mean_texture_color(const Object& object,
                                              std::span<const SurfaceGrid> grids,
                                              const LinearColor& base) {
  if (!object.colors.empty() || grids.empty()) return std::nullopt;
  const auto material_of = [&](const SurfaceGrid& grid) {
    return object.material_of[std::size_t(grid.first.triangle)];
  };
  const int common = material_of(grids[0]);
  if (std::any_of(grids.begin(), grids.end(),
                  [&](const SurfaceGrid& grid) { return material_of(grid) != common; }))
    return std::nullopt;
  const Material& material = object.materials[std::size_t(common)];
  if (material.texture < 0 || object.uvs.empty()) return color_at(object, grids[0].first, base);
  const Image& image = *object.textures[std::size_t(material.texture)];
  TexelPoints points;
  for (const SurfaceGrid& grid : grids) {
    const CornerUv& corners = object.uvs[std::size_t(grid.first.triangle)];
    points.add(along(corners, 0, grid, image.width_px, material.wrap_u),
               along(corners, 1, grid, image.height_px, material.wrap_v), grid.per_axis,
               grid.counted);
  }
  const auto mean = mean_of_texels(image, points);
  if (!mean) return std::nullopt;
  return over_base(*mean, material.base_color, base);
}

}  // namespace hydrodip
