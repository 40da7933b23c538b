#include "transfer/texture_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hydrodip {
namespace {

constexpr std::size_t kMostTexels = 4;  // under a grid, in a row or column

// A coordinate of a grid's points along one axis of a texture, in texels from the centre of the
// first one.
struct Along {
  float first = 0, across = 0, down = 0;

  float at(int column, int row) const { return first + float(column) * across + float(row) * down; }
  float least(int last) const {
    return first + float(last) * (std::min(across, 0.0F) + std::min(down, 0.0F));
  }
  float most(int last) const {
    return first + float(last) * (std::max(across, 0.0F) + std::max(down, 0.0F));
  }
};

Along along(const CornerUv& corners, Eigen::Index axis, const SurfaceGrid& grid, int size,
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

// Consecutive texels that hold the neighbours of all points; nothing if they are many, or if some
// lie beyond the texture.
struct Texels {
  int first = 0, count = 0;
};
std::optional<Texels> texels_under(const Along& along, int last, int size) {
  const float least = along.least(last), most = along.most(last);
  if (!(least >= 0 && most < float(size - 1))) return std::nullopt;
  const int first = int(least), count = int(most) - first + 2;
  if (count > int(kMostTexels)) return std::nullopt;
  return Texels{first, count};
}

using PerTexel = Eigen::Array4f;  // of a row or column

// Of a place to the texels 0, 1, ...: 1 in the middle of one, 0 from the middle of the next one on.
PerTexel nearness(float at) { return (1 - (at - PerTexel(0, 1, 2, 3)).abs()).max(0); }

// Premultiplied.
std::optional<LinearColor> mean_of_texels(const Image& image, const Material& material,
                                          const CornerUv& corners, const SurfaceGrid& grid) {
  const Along x = along(corners, 0, grid, image.width_px, material.wrap_u);
  const Along y = along(corners, 1, grid, image.height_px, material.wrap_v);
  const int last = grid.per_axis - 1;
  const auto columns = texels_under(x, last, image.width_px);
  const auto rows = texels_under(y, last, image.height_px);
  if (!columns || !rows) return std::nullopt;

  // Bilinear between texels: every point has shares of four, by how near it is to each along both
  // axes. All rows and columns are always looked at, so that they fit into registers.
  std::array<PerTexel, kMostTexels> share;
  share.fill(PerTexel::Zero());
  for (int row = 0; row <= last; ++row)
    for (int column = 0; column <= last; ++column) {
      if (!grid.counts(column, row)) continue;
      const PerTexel near_x = nearness(x.at(column, row) - float(columns->first));
      const PerTexel near_y = nearness(y.at(column, row) - float(rows->first));
      for (std::size_t j = 0; j < kMostTexels; ++j) share[j] += near_y[Eigen::Index(j)] * near_x;
    }

  const std::array<float, 256>& decode = srgb8_table();
  const float weight = 1.0F / (255.0F * float(grid.count()));
  LinearColor sum{0, 0, 0, 0};
  for (int j = 0; j < rows->count; ++j) {
    // v runs up, rows run down.
    const std::uint8_t* texel = image.pixel(columns->first, image.height_px - 1 - rows->first - j);
    for (int i = 0; i < columns->count; ++i, texel += 4) {
      const float alpha = share[std::size_t(j)][i] * weight * float(texel[3]);
      sum.r += alpha * decode[texel[0]];
      sum.g += alpha * decode[texel[1]];
      sum.b += alpha * decode[texel[2]];
      sum.a += alpha;
    }
  }
  return sum;
}

}  // namespace

std::optional<LinearColor> mean_texture_color(const Object& object, const SurfaceGrid& grid,
                                              const LinearColor& base) {
  if (!object.colors.empty()) return std::nullopt;
  const auto triangle = std::size_t(grid.first.triangle);
  const Material& material = object.materials[std::size_t(object.material_of[triangle])];
  if (material.texture < 0 || object.uvs.empty()) return color_at(object, grid.first, base);
  const auto mean = mean_of_texels(*object.textures[std::size_t(material.texture)], material,
                                   object.uvs[triangle], grid);
  if (!mean) return std::nullopt;
  const LinearColor& tint = material.base_color;
  const float rest = 1 - mean->a * tint.a;
  return LinearColor{mean->r * tint.r * tint.a + rest * base.r,
                     mean->g * tint.g * tint.a + rest * base.g,
                     mean->b * tint.b * tint.a + rest * base.b, 1};
}

}  // namespace hydrodip
