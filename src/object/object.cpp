#include "object/object.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hydrodip {

namespace {

// The two texels that a coordinate falls between, and the weight of the second.
struct TexelPair {
  int first;
  int second;
  float weight;
};

// Texture coordinates this small fit an int.
constexpr float kPlain = 1e6F;
constexpr float kFarthest = 1e30F;

// std::floor of those, which need not be a call.
float floored(float x) {
  const auto whole = static_cast<float>(static_cast<int>(x));
  return whole > x ? whole - 1 : whole;
}

TexelPair texels(float coordinate, int size, Wrap wrap) {
  float t = coordinate;
  switch (wrap) {
    case Wrap::kRepeat:
      // Those so far out that they may have grown to infinity between corners mean nothing, as does
      // what is no number.
      t = std::abs(t) < kPlain ? t - floored(t) : std::abs(t) < kFarthest ? t - std::floor(t) : 0;
      break;
    case Wrap::kMirror:
      t = std::abs(t) < kFarthest ? t - 2 * std::floor(t / 2) : 0;
      if (t > 1) t = 2 - t;
      break;
    case Wrap::kClamp:
    case Wrap::kDecal:
      t = t > 0 ? std::min(t, 1.0f) : 0;
      break;
  }
  const float x = t * float(size) - 0.5f;
  const float cell = floored(x);
  TexelPair pair{int(cell), int(cell) + 1, x - cell};
  if (wrap == Wrap::kRepeat) {
    if (pair.first < 0) pair.first += size;
    if (pair.second >= size) pair.second -= size;
  } else {
    pair.first = std::max(pair.first, 0);
    pair.second = std::min(pair.second, size - 1);
  }
  return pair;
}

// Premultiplied, in linear light.
LinearColor sample(const Image& image, const Material& material, const Eigen::Vector2f& uv) {
  const std::array<float, 256>& decode = srgb8_table();
  const TexelPair x = texels(uv.x(), image.width_px, material.wrap_u);
  const TexelPair row = texels(uv.y(), image.height_px, material.wrap_v);
  // v runs up, rows run down.
  const int low = image.height_px - 1 - row.first;
  const int high = image.height_px - 1 - row.second;
  LinearColor sum{0, 0, 0, 0};
  add_pixel(image.pixel(x.first, low), (1 - x.weight) * (1 - row.weight), decode, sum);
  add_pixel(image.pixel(x.second, low), x.weight * (1 - row.weight), decode, sum);
  add_pixel(image.pixel(x.first, high), (1 - x.weight) * row.weight, decode, sum);
  add_pixel(image.pixel(x.second, high), x.weight * row.weight, decode, sum);
  return sum;
}

bool outside(float t) { return t < 0 || t > 1; }

// Whether the texture shows at all here.
bool covered(const Material& material, const Eigen::Vector2f& uv) {
  return !(material.wrap_u == Wrap::kDecal && outside(uv.x())) &&
         !(material.wrap_v == Wrap::kDecal && outside(uv.y()));
}

// Multiplies a premultiplied colour by a straight factor.
void tint(LinearColor& color, const LinearColor& factor) {
  color.r *= factor.r * factor.a;
  color.g *= factor.g * factor.a;
  color.b *= factor.b * factor.a;
  color.a *= factor.a;
}

LinearColor blend(const CornerColor& corners, float w0, float w1, float w2) {
  return {w0 * corners[0].r + w1 * corners[1].r + w2 * corners[2].r,
          w0 * corners[0].g + w1 * corners[1].g + w2 * corners[2].g,
          w0 * corners[0].b + w1 * corners[1].b + w2 * corners[2].b,
          w0 * corners[0].a + w1 * corners[1].a + w2 * corners[2].a};
}

bool same_color(const LinearColor& a, const LinearColor& b) {
  return a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a;
}

}  // namespace

std::optional<LinearColor> Object::one_color() const {
  if (!colors.empty()) return {};
  const Material* plain = nullptr;
  for (const int index : material_of) {
    const Material& material = materials[std::size_t(index)];
    if (material.texture >= 0 && !uvs.empty()) return {};
    if (plain && plain != &material && !same_color(plain->base_color, material.base_color))
      return {};
    plain = &material;
  }
  return plain ? plain->base_color : LinearColor{1, 1, 1, 1};
}

bool Object::has_appearance() const {
  const auto color = one_color();
  if (!color) return true;
  const bool white = color->r >= 1 && color->g >= 1 && color->b >= 1;
  if (white || !(color->a > 0)) return false;
  return std::any_of(material_of.begin(), material_of.end(),
                     [&](int index) { return !materials[std::size_t(index)].color_is_default; });
}

Box3 TriangleMesh::bounds() const {
  Box3 box;
  for (const Vec3& p : positions) box.add(p);
  return box;
}

Vec3 position_at(const TriangleMesh& mesh, const SurfacePoint& point) {
  const Triangle& t = mesh.triangles[std::size_t(point.triangle)];
  return (1 - point.u - point.v) * mesh.positions[std::size_t(t[0])] +
         point.u * mesh.positions[std::size_t(t[1])] + point.v * mesh.positions[std::size_t(t[2])];
}

Vec3 area_vector(const std::vector<Vec3>& positions, const Triangle& triangle) {
  const Vec3& a = positions[std::size_t(triangle[0])];
  return 0.5 *
         (positions[std::size_t(triangle[1])] - a).cross(positions[std::size_t(triangle[2])] - a);
}

Vec3 face_normal(const TriangleMesh& mesh, int triangle) {
  const Triangle& t = mesh.triangles[std::size_t(triangle)];
  const Vec3& a = mesh.positions[std::size_t(t[0])];
  const Vec3 normal =
      (mesh.positions[std::size_t(t[1])] - a).cross(mesh.positions[std::size_t(t[2])] - a);
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

LinearColor color_at(const Object& object, const SurfacePoint& point, const LinearColor& base) {
  const auto triangle = std::size_t(point.triangle);
  const Material& material = object.materials[std::size_t(object.material_of[triangle])];
  const float w1 = float(point.u), w2 = float(point.v), w0 = 1 - w1 - w2;
  LinearColor color{1, 1, 1, 1};
  if (material.texture >= 0 && !object.uvs.empty()) {
    const CornerUv& corners = object.uvs[triangle];
    const Eigen::Vector2f uv = w0 * corners[0] + w1 * corners[1] + w2 * corners[2];
    if (covered(material, uv)) {
      color = sample(*object.textures[std::size_t(material.texture)], material, uv);
    }
  }
  tint(color, material.base_color);
  if (!object.colors.empty()) tint(color, blend(object.colors[triangle], w0, w1, w2));
  const float rest = 1 - color.a;
  return {color.r + rest * base.r, color.g + rest * base.g, color.b + rest * base.b, 1};
}

}  // namespace hydrodip
