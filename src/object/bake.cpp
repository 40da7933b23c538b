#include "object/bake.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.h"

namespace hydrodip {
namespace {

// Of a triangle's patch: its corners are the centres of texels, so that bilinear sampling inside
// the triangle never leaves it.
constexpr int kLeastSide_px = 2, kMostSide_px = 4096;
// Around the triangle its colours go on for such a part of the patch: smaller copies of a texture
// (mipmaps) and JPEG mix texels, and its neighbours there are not its neighbours on the surface. As
// drawn eight pixels wide or more it stays free of them.
constexpr int kMarginOfSide = 16, kLeastWithMargin_px = 8;

int margin_of(int side_px) {
  return side_px < kLeastWithMargin_px ? 0 : std::max(1, side_px / kMarginOfSide);
}

// Where a triangle lies in the texture: its longest side along x, its shortest along y, so that
// long thin ones have texels along their length.
struct Patch {
  int x = 0, y = 0, width = kLeastSide_px, height = kLeastSide_px;
  // Of the triangle's corners: that of the longest and the shortest side, the longest side's other
  // and the shortest side's.
  std::array<std::size_t, 3> corner = {0, 1, 2};

  // From one of the triangle's corners to the next.
  int leg_x() const { return width - 1 - 2 * margin_of(width); }
  int leg_y() const { return height - 1 - 2 * margin_of(height); }
};

double area_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.positions[std::size_t(t[0])];
  return 0.5 * (mesh.positions[std::size_t(t[1])] - a)
                   .cross(mesh.positions[std::size_t(t[2])] - a)
                   .norm();
}

// A power of two, about as many texels to a millimetre as the density says.
int side_for(double length_mm, double texels_per_mm) {
  int side = kLeastSide_px;
  while (2 * side <= texels_per_mm * length_mm + 1 && side < kMostSide_px) side *= 2;
  return side;
}

Patch patch_for(const TriangleMesh& mesh, const Triangle& t, double texels_per_mm) {
  std::array<double, 3> length_mm{};  // of the side that faces each corner
  for (std::size_t k = 0; k < 3; ++k)
    length_mm[k] =
        (mesh.positions[std::size_t(t[(k + 1) % 3])] - mesh.positions[std::size_t(t[(k + 2) % 3])])
            .norm();
  const auto facing = [&](auto which) {
    return std::size_t(which(length_mm.begin(), length_mm.end()) - length_mm.begin());
  };
  Patch patch;
  const std::size_t by_longest = facing([](auto a, auto b) { return std::max_element(a, b); });
  std::size_t by_shortest = facing([](auto a, auto b) { return std::min_element(a, b); });
  if (by_shortest == by_longest) by_shortest = (by_longest + 1) % 3;  // all are as long
  patch.corner = {3 - by_longest - by_shortest, by_shortest, by_longest};
  patch.width = side_for(length_mm[by_longest], texels_per_mm);
  patch.height = side_for(length_mm[by_shortest], texels_per_mm);
  return patch;
}

std::vector<Patch> patches_for(const TriangleMesh& mesh, double texels_per_mm) {
  std::vector<Patch> patches(mesh.triangles.size());
  parallel_for(patches.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      patches[t] = patch_for(mesh, mesh.triangles[t], texels_per_mm);
  });
  return patches;
}

// The even bits of a number, drawn together: one coordinate of a place on the Z-order curve.
int every_second_bit(std::uint64_t place) {
  int coordinate = 0;
  for (int bit = 0; bit < 31; ++bit) coordinate |= int((place >> (2 * bit)) & 1U) << bit;
  return coordinate;
}

// As many patches of a size as fill a square lie on each other in it; the squares lie along the
// Z-order curve, the large ones first: if their sides are powers of two they never overlap. Returns
// the texels that they take.
std::uint64_t lay_out(std::vector<Patch>& patches) {
  std::vector<std::size_t> order(patches.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto size = [&](std::size_t t) { return std::pair(patches[t].width, patches[t].height); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  std::uint64_t place = 0;  // behind the last square
  int left = 0;             // patches that fit into it
  for (std::size_t i = 0; i < order.size(); ++i) {
    Patch& patch = patches[order[i]];
    if (left == 0 || size(order[i]) != size(order[i - 1])) {
      left = patch.width / patch.height;
      place += std::uint64_t(patch.width) * std::uint64_t(patch.width);
    }
    const std::uint64_t square = place - std::uint64_t(patch.width) * std::uint64_t(patch.width);
    --left;
    patch.x = every_second_bit(square);
    patch.y = every_second_bit(square >> 1U) + left * patch.height;
  }
  return place;
}

// Of the texels beyond the triangle's sides: about the nearest point of it.
SurfacePoint point_at(std::size_t triangle, const Patch& patch, int x, int y) {
  double along = double(std::max(0, x - margin_of(patch.width))) / patch.leg_x();
  double across = double(std::max(0, y - margin_of(patch.height))) / patch.leg_y();
  if (const double beyond = along + across - 1; beyond > 0) {
    along = std::clamp(along - beyond / 2, 0.0, 1.0);
    across = std::min(across, 1 - along);
  }
  std::array<double, 3> weight{};
  weight[patch.corner[0]] = 1 - along - across;
  weight[patch.corner[1]] = along;
  weight[patch.corner[2]] = across;
  return {int(triangle), weight[1], weight[2]};
}

void fill(const Paint& paint, std::size_t triangle, const Patch& patch, Image& texture) {
  for (int y = 0; y < patch.height; ++y)
    for (int x = 0; x < patch.width; ++x) {
      const LinearColor color = paint.color_at(point_at(triangle, patch, x, y));
      std::uint8_t* pixel = texture.pixel(patch.x + x, patch.y + y);
      pixel[0] = linear_to_srgb8(color.r);
      pixel[1] = linear_to_srgb8(color.g);
      pixel[2] = linear_to_srgb8(color.b);
      pixel[3] = 255;
    }
}

// v runs up, rows run down.
CornerUv corners_of(const Patch& patch, int side_px) {
  const auto at = [&](int x, int y) {
    return Eigen::Vector2f(float((patch.x + x + 0.5) / side_px),
                           float(1 - (patch.y + y + 0.5) / side_px));
  };
  const int left = margin_of(patch.width), upper = margin_of(patch.height);
  CornerUv uv;
  uv[patch.corner[0]] = at(left, upper);
  uv[patch.corner[1]] = at(left + patch.leg_x(), upper);
  uv[patch.corner[2]] = at(left, upper + patch.leg_y());
  return uv;
}

// What patches of the least size would hold.
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
  std::vector<Patch> patches = patches_for(mesh, density);
  std::uint64_t texels = lay_out(patches);
  for (int halvings = 0; double(texels) > double(most_px) * most_px && halvings < 24; ++halvings) {
    density /= 2;
    patches = patches_for(mesh, density);
    texels = lay_out(patches);
  }
  const bool all_least = std::all_of(patches.begin(), patches.end(), [](const Patch& patch) {
    return patch.width == kLeastSide_px;
  });
  if (all_least) {
    object.colors = corner_colors(mesh, paint);
    return object;
  }
  const auto side_px =
      int(std::bit_ceil(std::max(2U, unsigned(std::ceil(std::sqrt(double(texels)))))));
  auto texture = std::make_shared<Image>(side_px, side_px);
  parallel_for(patches.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) fill(paint, t, patches[t], *texture);
  });
  for (const Patch& patch : patches) object.uvs.push_back(corners_of(patch, side_px));
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
