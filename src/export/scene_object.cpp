#include "export/scene_object.h"

#include "image/files.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "render/normals.h"

namespace hydrodip {
namespace {

constexpr double kCrease_deg = 30;  // as in maps.png: edges sharper than this stay edges

std::array<float, 3> to_floats(const Vec3& v) { return {float(v.x()), float(v.y()), float(v.z())}; }

// Positions drawn to a grid of the given spacing; 0: as they are.
std::vector<Vec3> snapped(const std::vector<Vec3>& positions, double spacing) {
  std::vector<Vec3> result = positions;
  if (spacing > 0) {
    for (Vec3& p : result) p = (p / spacing).array().round().matrix() * spacing;
  }
  return result;
}

std::vector<std::size_t> remaining(const Object& object, const std::vector<Vec3>& positions) {
  std::vector<std::size_t> triangles;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Triangle& v = object.triangles[t];
    const Vec3 &a = positions[std::size_t(v[0])], &b = positions[std::size_t(v[1])],
               &c = positions[std::size_t(v[2])];
    if (a != b && b != c && c != a) triangles.push_back(t);
  }
  return triangles;
}

ShownVertex corner(const Object& object, const std::vector<Vec3>& positions,
                   const CornerNormals& normals, std::size_t t, std::size_t k) {
  ShownVertex vertex;
  vertex.position = to_floats(positions[std::size_t(object.triangles[t][k])]);
  vertex.normal = to_floats(normals[k]);
  if (!object.uvs.empty()) vertex.uv = {object.uvs[t][k].x(), object.uvs[t][k].y()};
  vertex.color = {1, 1, 1, 1};
  if (!object.colors.empty()) {
    const LinearColor& c = object.colors[t][k];
    vertex.color = {c.r, c.g, c.b, c.a};
  }
  return vertex;
}

struct Hash {
  std::size_t operator()(const ShownVertex& vertex) const {
    std::uint64_t hash = 0;
    const auto add = [&](const auto& values) {
      for (const float value : values) {
        // Plus 0: -0 equals 0.
        hash = (hash ^ std::bit_cast<std::uint32_t>(value + 0.0F)) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
      }
    };
    add(vertex.position);
    add(vertex.normal);
    add(vertex.uv);
    add(vertex.color);
    return hash;
  }
};

}  // namespace

ShownObject shown_object(const Object& object, std::size_t most_triangles) {
  std::vector<Vec3> positions = object.positions;
  std::vector<std::size_t> triangles = remaining(object, positions);
  ShownObject shown;
  const double extent = object.bounds().empty() ? 0 : object.bounds().size().maxCoeff();
  for (double cells = 1024; triangles.size() > most_triangles && cells > 8; cells /= 1.4) {
    positions = snapped(object.positions, extent / cells);
    triangles = remaining(object, positions);
    shown.simplified = true;
  }
  std::stable_sort(triangles.begin(), triangles.end(), [&](std::size_t a, std::size_t b) {
    return object.material_of[a] < object.material_of[b];
  });

  const auto normals = corner_normals(object.positions, object.triangles, kCrease_deg);
  std::unordered_map<ShownVertex, std::uint32_t, Hash> known;
  known.reserve(triangles.size());
  for (const std::size_t t : triangles) {
    const int material = object.material_of[t];
    if (shown.groups.empty() || shown.groups.back().material != material)
      shown.groups.push_back({material, shown.indices.size(), 0});
    shown.groups.back().count += 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const ShownVertex vertex = corner(object, positions, normals[t], t, k);
      const auto [where, is_new] = known.try_emplace(vertex, std::uint32_t(known.size()));
      if (is_new) shown.vertices.push_back(vertex);
      shown.indices.push_back(where->second);
    }
  }
  return shown;
}

ShownPicture shown_picture(const Image& image, int jpeg_quality) {
  bool opaque = true;
  for (std::size_t i = 3; opaque && i < image.rgba.size(); i += 4) opaque = image.rgba[i] == 255;
  if (opaque) return {"image/jpeg", encode_jpeg(image, jpeg_quality)};
  return {"image/png", encode_png(image)};
}

const char* wrap_name(Wrap wrap) {
  switch (wrap) {
    case Wrap::kRepeat:
      return "repeat";
    case Wrap::kMirror:
      return "mirror";
    case Wrap::kClamp:
      return "clamp";
    case Wrap::kDecal:
      break;
  }
  return "decal";
}

}  // namespace hydrodip
