#include "object/bake.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace hydrodip {
namespace {

// Of a triangle's square: its corners are the centres of texels, so that bilinear sampling inside
// the triangle never leaves it.
constexpr int kLeastSide_px = 2;
// Around the triangle its colours go on for such a part of the square: smaller copies of a texture
// (mipmaps) and JPEG mix texels, and its neighbours there are not its neighbours on the surface. As
// drawn eight pixels wide or more it stays free of them.
constexpr int kMarginOfSide = 16, kLeastWithMargin_px = 8;

struct Square {
  int x = 0, y = 0, side = kLeastSide_px;

  int margin() const { return side < kLeastWithMargin_px ? 0 : std::max(1, side / kMarginOfSide); }
  // From one of the triangle's corners to the next.
  int leg() const { return side - 1 - 2 * margin(); }
};

double area_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.positions[std::size_t(t[0])];
  return 0.5 * (mesh.positions[std::size_t(t[1])] - a)
                   .cross(mesh.positions[std::size_t(t[2])] - a)
                   .norm();
}

// Powers of two, about as many texels to a millimetre as the density says.
std::vector<int> sides_for(const TriangleMesh& mesh, double texels_per_mm) {
  std::vector<int> sides;
  for (const Triangle& t : mesh.triangles) {
    const double wanted = texels_per_mm * std::sqrt(2 * area_of(mesh, t)) + 1;
    int side = kLeastSide_px;
    while (2 * side <= wanted && side < 4096) side *= 2;
    sides.push_back(side);
  }
  return sides;
}

double area_px(const std::vector<int>& sides) {
  double sum = 0;
  for (const int side : sides) sum += double(side) * side;
  return sum;
}

// The even bits of a number, drawn together: one coordinate of a place on the Z-order curve.
int every_second_bit(std::uint64_t place) {
  int coordinate = 0;
  for (int bit = 0; bit < 31; ++bit) coordinate |= int((place >> (2 * bit)) & 1U) << bit;
  return coordinate;
}

// Along the Z-order curve, the large ones first: squares whose sides are powers of two then never
// overlap.
std::vector<Square> laid_out(const std::vector<int>& sides) {
  std::vector<std::size_t> order(sides.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sides[a] > sides[b]; });
  std::vector<Square> squares(sides.size());
  std::uint64_t place = 0;
  for (const std::size_t t : order) {
    squares[t] = {every_second_bit(place), every_second_bit(place >> 1U), sides[t]};
    place += std::uint64_t(sides[t]) * std::uint64_t(sides[t]);
  }
  return squares;
}

// Of the texels beyond the triangle's sides: about the nearest point of it.
SurfacePoint point_at(std::size_t triangle, const Square& square, int x, int y) {
  double u = double(std::max(0, x - square.margin())) / square.leg();
  double v = double(std::max(0, y - square.margin())) / square.leg();
  if (const double beyond = u + v - 1; beyond > 0) {
    u = std::clamp(u - beyond / 2, 0.0, 1.0);
    v = 1 - u;
  }
  return {int(triangle), u, v};
}

void fill(const Paint& paint, std::size_t triangle, const Square& square, Image& texture) {
  for (int y = 0; y < square.side; ++y)
    for (int x = 0; x < square.side; ++x) {
      const LinearColor color = paint.color_at(point_at(triangle, square, x, y));
      std::uint8_t* pixel = texture.pixel(square.x + x, square.y + y);
      pixel[0] = linear_to_srgb8(color.r);
      pixel[1] = linear_to_srgb8(color.g);
      pixel[2] = linear_to_srgb8(color.b);
      pixel[3] = 255;
    }
}

// v runs up, rows run down.
CornerUv corners_of(const Square& square, int side_px) {
  const auto at = [&](int x, int y) {
    return Eigen::Vector2f(float((square.x + x + 0.5) / side_px),
                           float(1 - (square.y + y + 0.5) / side_px));
  };
  const int first = square.margin(), last = first + square.leg();
  return {at(first, first), at(last, first), at(first, last)};
}

// What squares of the least size would hold.
std::vector<CornerColor> corner_colors(const TriangleMesh& mesh, const Paint& paint) {
  std::vector<CornerColor> colors(mesh.triangles.size());
  parallel_for(colors.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      colors[t] = {paint.color_at({int(t), 0, 0}), paint.color_at({int(t), 1, 0}),
                   paint.color_at({int(t), 0, 1})};
  });
  return colors;
}

Object baked(const TriangleMesh& mesh, const Paint& paint, int most_px) {
  Object object;
  static_cast<TriangleMesh&>(object) = mesh;
  object.materials.resize(1);
  object.materials[0].name = "baked";
  object.materials[0].wrap_u = object.materials[0].wrap_v = Wrap::kClamp;
  object.material_of.assign(mesh.triangles.size(), 0);
  if (mesh.triangles.empty()) return object;

  double total_mm2 = 0;
  for (const Triangle& t : mesh.triangles) total_mm2 += area_of(mesh, t);
  double density = total_mm2 > 0 ? most_px / std::sqrt(total_mm2) : 1;
  std::vector<int> sides = sides_for(mesh, density);
  for (int halvings = 0; area_px(sides) > double(most_px) * most_px && halvings < 24; ++halvings) {
    density /= 2;
    sides = sides_for(mesh, density);
  }
  if (*std::max_element(sides.begin(), sides.end()) == kLeastSide_px) {
    object.colors = corner_colors(mesh, paint);
    return object;
  }
  const auto side_px =
      int(std::bit_ceil(std::max(2U, unsigned(std::ceil(std::sqrt(area_px(sides)))))));
  const std::vector<Square> squares = laid_out(sides);
  auto texture = std::make_shared<Image>(side_px, side_px);
  parallel_for(squares.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) fill(paint, t, squares[t], *texture);
  });
  for (const Square& square : squares) object.uvs.push_back(corners_of(square, side_px));
  object.textures.push_back(std::move(texture));
  object.materials[0].texture = 0;
  return object;
}

}  // namespace

Object painted_object(const TriangleMesh& mesh, const Paint& paint, int most_px) {
  if (const Object* given = paint.as_object()) {
    Object object = *given;
    object.positions = mesh.positions;
    return object;
  }
  return baked(mesh, paint, most_px);
}

}  // namespace hydrodip
