#include "transfer/texel_mean.h"

#include <Eigen/Core>
#include <cmath>
#include <cstring>

namespace hydrodip {
namespace {

constexpr int kMostTexels = 4;  // under all points, in a row or column

// Consecutive texels that hold the neighbours of all points; none if some lie beyond the picture,
// or if they are many.
struct Texels {
  int first = 0, count = 0;

  Texels(float least, float most, int size) {
    if (!(least >= 0 && most < float(size - 1))) return;
    first = int(least);
    count = int(most) - first + 2;
    if (count > kMostTexels) count = 0;
  }
};

struct TexelBlock {
  const Image& image;
  Texels columns, rows;

  bool exists() const { return columns.count > 0 && rows.count > 0; }
  // y runs up, rows run down.
  const std::uint8_t* row(int j) const {
    return image.pixel(columns.first, image.height_px - 1 - rows.first - j);
  }
  bool is_of_one_color() const {
    const std::uint32_t first = texel(row(0));
    std::uint32_t differs = 0;
    for (int j = 0; j < rows.count; ++j) {
      const std::uint8_t* at = row(j);
      for (int i = 0; i < columns.count; ++i, at += 4) differs |= texel(at) ^ first;
    }
    return differs == 0;
  }

 private:
  static std::uint32_t texel(const std::uint8_t* at) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, at, sizeof bytes);
    return bytes;
  }
};

// Premultiplied, by its share of the mean.
void add_texel(const std::uint8_t* texel, float share, LinearColor& sum) {
  const std::array<float, 256>& decode = srgb8_table();
  const float alpha = share * float(texel[3]);
  sum.r += alpha * decode[texel[0]];
  sum.g += alpha * decode[texel[1]];
  sum.b += alpha * decode[texel[2]];
  sum.a += alpha;
}

LinearColor color_of_all(const TexelBlock& block) {
  LinearColor color{0, 0, 0, 0};
  add_texel(block.row(0), 1.0F / 255.0F, color);
  return color;
}

using PerTexel = Eigen::Array4f;  // of a row or column

// Of a place to the texels 0, 1, ...: 1 in the middle of one, 0 from the middle of the next one on.
PerTexel nearness(float at) { return (1 - (at - PerTexel(0, 1, 2, 3)).abs()).max(0); }

// Every point has shares of four texels, by how near it is to each along both axes. All rows and
// columns are always looked at, so that they fit into registers.
LinearColor mean_of_block(const TexelBlock& block, const TexelPoints& points) {
  std::array<PerTexel, kMostTexels> share;
  share.fill(PerTexel::Zero());
  const auto left = float(block.columns.first), lower = float(block.rows.first);
  for (std::size_t n = 0; n < points.count(); ++n) {
    const PerTexel near_x = nearness(points.x()[n] - left),
                   near_y = nearness(points.y()[n] - lower);
    for (std::size_t j = 0; j < share.size(); ++j) share[j] += near_y[Eigen::Index(j)] * near_x;
  }
  const float weight = 1.0F / (255.0F * float(points.count()));
  LinearColor sum{0, 0, 0, 0};
  for (int j = 0; j < block.rows.count; ++j) {
    const std::uint8_t* texel = block.row(j);
    for (int i = 0; i < block.columns.count; ++i, texel += 4)
      add_texel(texel, share[std::size_t(j)][i] * weight, sum);
  }
  return sum;
}

}  // namespace

void TexelPoints::add(const TexelsAlong& x, const TexelsAlong& y, int per_axis,
                      std::uint64_t counted) {
  for (int row = 0; row < per_axis; ++row)
    for (int column = 0; column < per_axis; ++column, counted >>= 1) {
      if ((counted & 1U) == 0) continue;
      const float at_x = x.at(column, row), at_y = y.at(column, row);
      x_[count_] = at_x;
      y_[count_++] = at_y;
      least_x_ = std::min(least_x_, at_x);
      most_x_ = std::max(most_x_, at_x);
      least_y_ = std::min(least_y_, at_y);
      most_y_ = std::max(most_y_, at_y);
    }
}

std::optional<LinearColor> mean_of_texels(const Image& image, const TexelPoints& points) {
  const TexelBlock block{image, Texels(points.least_x(), points.most_x(), image.width_px),
                         Texels(points.least_y(), points.most_y(), image.height_px)};
  if (!block.exists()) return std::nullopt;
  return block.is_of_one_color() ? color_of_all(block) : mean_of_block(block, points);
}

std::optional<LinearColor> mean_of_texels(const Image& image, const TexelsAlong& x,
                                          const TexelsAlong& y, int per_axis) {
  const int last = per_axis - 1;
  const TexelBlock block{image, Texels(x.least(last), x.most(last), image.width_px),
                         Texels(y.least(last), y.most(last), image.height_px)};
  if (!block.exists()) return std::nullopt;
  if (block.is_of_one_color()) return color_of_all(block);
  TexelPoints points;
  points.add(x, y, per_axis, ~std::uint64_t(0));
  return mean_of_block(block, points);
}

}  // namespace hydrodip
