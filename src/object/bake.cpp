#include "object/bake.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/run_scope.h"
#include "object/charts.h"

namespace hydrodip {
namespace {

constexpr int kLeastSide_px = 2, kMostSide_px = 4096;
// Around a patch its colours go on for such a part of it: smaller copies of a texture (mipmaps) and
// JPEG mix texels, and its neighbours there are not its neighbours on the surface. As drawn eight
// pixels wide or more it stays free of them, if it has the room.
constexpr int kMarginOfSide = 16, kLeastWithMargin_px = 4;
// So far from it the nearest point of a chart is looked for.
constexpr int kNearest_px = 4;
constexpr std::size_t kMostLookedAt = 16;
constexpr double kFiner = 1.189207;  // the fourth root of 2

int margin_of(int side_px) {
  if (side_px < kLeastWithMargin_px) return 0;
  return std::max(side_px < 16 ? 1 : 2, side_px / kMarginOfSide);
}

// The plane of a triangle, with its longest side along x.
class Plane {
 public:
  Plane(const TriangleMesh& mesh, std::size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const auto corner = [&](std::size_t k) { return mesh.positions[std::size_t(t[k % 3])]; };
    std::size_t longest = 0;
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (const double other = (corner(k + 1) - corner(k)).norm(); other > length) {
        longest = k;
        length = other;
      }
    origin_ = corner(longest);
    if (!(length > 0)) return;
    along_ = (corner(longest + 1) - origin_) / length;
    const Vec3 to_third = corner(longest + 2) - origin_;
    across_ = to_third - to_third.dot(along_) * along_;
    across_.stableNormalize();
  }
  Vec2 operator()(const Vec3& point) const {
    return {(point - origin_).dot(along_), (point - origin_).dot(across_)};
  }

 private:
  Vec3 origin_ = Vec3::Zero(), along_ = Vec3::Zero(), across_ = Vec3::Zero();
};

// A chart of the surface and its place in the texture. What bounds it runs through the centres
// of texels, so that bilinear sampling inside never leaves it.
struct Patch {
  std::size_t first = 0, count = 0;  // of Patches::triangles; the plane is the first one's
  Vec2 along = Vec2::UnitX();        // of the plane: the longer of the rectangle's sides
  Vec2 low_mm = Vec2::Zero(), size_mm = Vec2::Zero();
  int x = 0, y = 0, width = kLeastSide_px, height = kLeastSide_px;

  Vec2 turned(const Vec2& in_plane_mm) const {
    return {in_plane_mm.dot(along), cross2(along, in_plane_mm)};
  }
  // From the texture's corner; whole numbers are texels' centres.
  Vec2 texel(const Vec2& in_plane_mm) const {
    const Vec2 share = (turned(in_plane_mm) - low_mm).cwiseQuotient(size_mm.cwiseMax(1e-30));
    const auto place = [](double share, int side_px) {
      const int margin = margin_of(side_px);
      return margin + share * (side_px - 1 - 2 * margin);
    };
    return {x + place(share.x(), width), y + place(share.y(), height)};
  }
};

struct Patches {
  std::vector<std::size_t> triangles;  // one patch's behind another's
  std::vector<Patch> list;
};

// The smallest rectangle along a side of one of the first triangles.
void bound(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles, Patch& patch) {
  const Plane plane(mesh, triangles[patch.first]);
  std::vector<std::array<Vec2, 3>> flat(patch.count);
  for (std::size_t i = 0; i < patch.count; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      flat[i][k] =
          plane(mesh.positions[std::size_t(mesh.triangles[triangles[patch.first + i]][k])]);
  double least_mm2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(patch.count, kMostLookedAt); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      Patch tried = patch;
      tried.along = flat[i][(k + 1) % 3] - flat[i][k];
      if (!(tried.along.norm() > 0)) continue;
      tried.along.normalize();
      const auto box_of = [&] {
        Box2 box;
        for (const auto& corners : flat)
          for (const Vec2& corner : corners) box.add(tried.turned(corner));
        return box;
      };
      Box2 box = box_of();
      if ((box.max - box.min).prod() >= least_mm2) continue;
      if (box.max.y() - box.min.y() > box.max.x() - box.min.x()) {
        tried.along = Vec2(-tried.along.y(), tried.along.x());
        box = box_of();
      }
      least_mm2 = (box.max - box.min).prod();
      tried.low_mm = box.min;
      tried.size_mm = box.max - box.min;
      patch = tried;
    }
}

Patches patches_of(const TriangleMesh& mesh) {
  Patches patches;
  for (const std::vector<std::size_t>& chart : charts(mesh)) {
    Patch patch;
    patch.first = patches.triangles.size();
    patch.count = chart.size();
    patches.list.push_back(patch);
    patches.triangles.insert(patches.triangles.end(), chart.begin(), chart.end());
  }
  parallel_for(patches.list.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) bound(mesh, patches.triangles, patches.list[n]);
  });
  return patches;
}

// Powers of two, about as many texels to a millimetre as the density says.
void size_patches(std::vector<Patch>& patches, double texels_per_mm) {
  const auto side_for = [&](double length_mm) {
    int side = kLeastSide_px;
    while (2 * side <= texels_per_mm * length_mm + 1 && side < kMostSide_px) side *= 2;
    return side;
  };
  for (Patch& patch : patches) {
    patch.width = side_for(patch.size_mm.maxCoeff());
    patch.height = side_for(patch.size_mm.minCoeff());
  }
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
  const auto size = [&](std::size_t n) { return std::pair(patches[n].width, patches[n].height); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  std::uint64_t place = 0;  // behind the last square
  int left = 0;             // patches that fit into it
  for (std::size_t i = 0; i < order.size(); ++i) {
    Patch& patch = patches[order[i]];
    const std::uint64_t square_px = std::uint64_t(patch.width) * std::uint64_t(patch.width);
    if (left == 0 || size(order[i]) != size(order[i - 1])) {
      left = patch.width / patch.height;
      place += square_px;
    }
    --left;
    patch.x = every_second_bit(place - square_px);
    patch.y = every_second_bit((place - square_px) >> 1U) + left * patch.height;
  }
  return place;
}

// One patch's colours.
class Filling {
 public:
  Filling(const TriangleMesh& mesh, const Paint& paint, const Patches& patches, Image& texture)
      : mesh_(mesh), paint_(paint), patches_(patches), texture_(texture) {}

  void fill(const Patch& patch) const {
    const auto texels = std::size_t(patch.width) * std::size_t(patch.height);
    std::vector<Nearest> nearest(texels);
    const Plane plane(mesh_, patches_.triangles[patch.first]);
    CheckEvery check(64);
    for (std::size_t i = 0; i < patch.count; ++i) {
      check();
      look_for(patches_.triangles[patch.first + i], patch, plane, nearest);
    }
    spread(patch, nearest);
    for (int y = 0; y < patch.height; ++y) {
      check();
      for (int x = 0; x < patch.width; ++x) {
        const Nearest& at = nearest[std::size_t(y) * std::size_t(patch.width) + std::size_t(x)];
        store(paint_.color_at(at.point), texture_.pixel(patch.x + x, patch.y + y));
      }
    }
  }

 private:
  struct Nearest {
    SurfacePoint point{-1, 0, 0};
    double distance_px = 1e300;
  };

  // The texels in a triangle and next to it.
  void look_for(std::size_t triangle, const Patch& patch, const Plane& plane,
                std::vector<Nearest>& nearest) const {
    std::array<Vec2, 3> corner;
    Box2 box;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = patch.texel(plane(mesh_.positions[std::size_t(mesh_.triangles[triangle][k])])) -
                  Vec2(patch.x, patch.y);
      box.add(corner[k]);
    }
    const Vec2 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const double twice = cross2(e1, e2);
    const auto [first_y, last_y] = texels_near(box.min.y(), box.max.y(), patch.height);
    for (int y = first_y; y <= last_y; ++y) {
      // One more, so that the triangle always meets it.
      const auto [low, high] = across_band(corner, y - kNearest_px - 1, y + kNearest_px + 1);
      const auto [first_x, last_x] = texels_near(low, high, patch.width);
      for (int x = first_x; x <= last_x; ++x) {
        const Vec2 to = Vec2(x, y) - corner[0];
        // No weight below 0: about the nearest point of the triangle.
        double u = 0, v = 0;
        if (twice != 0) {
          u = std::clamp(cross2(to, e2) / twice, 0.0, 1.0);
          v = std::clamp(cross2(e1, to) / twice, 0.0, 1.0);
        }
        if (u + v > 1) {
          u = std::clamp(u - (u + v - 1) / 2, 0.0, 1.0);
          v = 1 - u;
        }
        const double distance_px = (to - u * e1 - v * e2).norm();
        Nearest& at = nearest[std::size_t(y) * std::size_t(patch.width) + std::size_t(x)];
        if (!(distance_px < at.distance_px)) continue;
        at = {{int(triangle), u, v}, distance_px};
      }
    }
  }

  // Further away as in the nearest column, then as in the nearest row.
  static void spread(const Patch& patch, std::vector<Nearest>& nearest) {
    const auto at = [&](int x, int y) -> Nearest& {
      return nearest[std::size_t(y) * std::size_t(patch.width) + std::size_t(x)];
    };
    const auto take = [](Nearest& here, const Nearest& beside) {
      if (here.point.triangle < 0) here = beside;
    };
    for (int y = 0; y < patch.height; ++y) {
      for (int x = 1; x < patch.width; ++x) take(at(x, y), at(x - 1, y));
      for (int x = patch.width - 2; x >= 0; --x) take(at(x, y), at(x + 1, y));
    }
    for (int x = 0; x < patch.width; ++x) {
      for (int y = 1; y < patch.height; ++y) take(at(x, y), at(x, y - 1));
      for (int y = patch.height - 2; y >= 0; --y) take(at(x, y), at(x, y + 1));
    }
  }

  static std::pair<int, int> texels_near(double low, double high, int side_px) {
    return {std::max(0, int(std::floor(low)) - kNearest_px),
            std::min(side_px - 1, int(std::ceil(high)) + kNearest_px)};
  }

  // From where to where a triangle reaches between two heights that it meets.
  static std::pair<double, double> across_band(const std::array<Vec2, 3>& corner, double low,
                                               double high) {
    double least = 1e300, most = -1e300;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 &a = corner[k], &b = corner[(k + 1) % 3];
      for (const double y : {std::clamp(a.y(), low, high), std::clamp(b.y(), low, high)}) {
        if (y < std::min(a.y(), b.y()) || y > std::max(a.y(), b.y())) continue;
        const double x =
            a.y() == b.y() ? a.x() : a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y());
        least = std::min({least, x, a.y() == b.y() ? b.x() : x});
        most = std::max({most, x, a.y() == b.y() ? b.x() : x});
      }
    }
    return {least, most};
  }

  static void store(const LinearColor& color, std::uint8_t* pixel) {
    pixel[0] = linear_to_srgb8(color.r);
    pixel[1] = linear_to_srgb8(color.g);
    pixel[2] = linear_to_srgb8(color.b);
    pixel[3] = 255;
  }

  const TriangleMesh& mesh_;
  const Paint& paint_;
  const Patches& patches_;
  Image& texture_;
};

// What no patch covers gets the mean of what they do: the smallest copies mix it in.
void fill_rest(Image& texture) {
  std::array<std::uint64_t, 4> sum{};
  std::uint64_t count = 0;
  const auto each = [&](const auto& visit) {
    CheckEvery check(1 << 16);
    for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
      check();
      visit(texture.rgba.data() + i);
    }
  };
  each([&](const std::uint8_t* p) {
    if (p[3] == 0) return;
    for (std::size_t k = 0; k < 4; ++k) sum[k] += p[k];
    ++count;
  });
  if (count == 0) return;
  std::array<std::uint8_t, 4> mean{};
  for (std::size_t k = 0; k < 4; ++k) mean[k] = std::uint8_t((sum[k] + count / 2) / count);
  each([&](std::uint8_t* p) {
    if (p[3] == 0) std::copy(mean.begin(), mean.end(), p);
  });
}

// v runs up, rows run down.
void tell_corners(const TriangleMesh& mesh, const Patches& patches, const Patch& patch, int side_px,
                  std::vector<CornerUv>& uvs) {
  const Plane plane(mesh, patches.triangles[patch.first]);
  for (std::size_t i = 0; i < patch.count; ++i) {
    const std::size_t t = patches.triangles[patch.first + i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 at = patch.texel(plane(mesh.positions[std::size_t(mesh.triangles[t][k])]));
      uvs[t][k] =
          Eigen::Vector2f(float((at.x() + 0.5) / side_px), float(1 - (at.y() + 0.5) / side_px));
    }
  }
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

Object baked(const TriangleMesh& mesh, const Paint& paint, const TextureSize& size) {
  Object object;
  static_cast<TriangleMesh&>(object) = mesh;
  object.materials.resize(1);
  object.materials[0].name = "baked";
  object.materials[0].wrap_u = object.materials[0].wrap_v = Wrap::kClamp;
  object.material_of.assign(mesh.triangles.size(), 0);
  if (mesh.triangles.empty()) return object;

  Patches patches = patches_of(mesh);
  double total_mm2 = 0;
  for (const Patch& patch : patches.list) total_mm2 += patch.size_mm.prod();
  double density = total_mm2 > 0 ? 2 * size.most_px / std::sqrt(total_mm2) : 1;
  density = std::min(density, kFiner * size.finest);
  const double most_texels = double(size.most_px) * size.most_px;
  std::uint64_t texels = std::numeric_limits<std::uint64_t>::max();
  for (int smaller = 0; double(texels) > most_texels && smaller < 96; ++smaller) {
    density /= kFiner;
    size_patches(patches.list, density);
    texels = lay_out(patches.list);
  }
  const bool all_least =
      std::all_of(patches.list.begin(), patches.list.end(),
                  [](const Patch& patch) { return patch.width == kLeastSide_px; });
  if (all_least) {
    object.colors = corner_colors(mesh, paint);
    return object;
  }
  const auto side_px =
      int(std::bit_ceil(std::max(2U, unsigned(std::ceil(std::sqrt(double(texels)))))));
  auto texture = std::make_shared<Image>(side_px, side_px);
  object.uvs.resize(mesh.triangles.size());
  const Filling filling(mesh, paint, patches, *texture);
  parallel_for(patches.list.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      filling.fill(patches.list[n]);
      tell_corners(mesh, patches, patches.list[n], side_px, object.uvs);
    }
  });
  fill_rest(*texture);
  object.textures.push_back(std::move(texture));
  object.materials[0].texture = 0;
  return object;
}

}  // namespace

Object painted_object(const TriangleMesh& mesh, const Paint& paint, const TextureSize& size) {
  if (const Object* given = paint.as_object()) {
    Object object = *given;
    object.positions = mesh.positions;
    return object;
  }
  return baked(mesh, paint, size);
}

}  // namespace hydrodip
