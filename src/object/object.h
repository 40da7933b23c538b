// What is dipped: a triangle mesh, and what a model file says of its colours.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

enum class Wrap { kRepeat, kMirror, kClamp, kDecal };  // kDecal: base colour outside [0, 1]

struct Material {
  std::string name;
  LinearColor base_color{1, 1, 1, 1};  // multiplies the texture and the vertex colour
  int texture = -1;                    // index into Object::textures, -1: none
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
  // base_color is what its file format says of materials that state none: it asks for nothing.
  bool color_is_default = false;
};

// Per-triangle-corner texture coordinates keep seams sharp: two triangles that share an edge need
// not agree on it. Convention: v = 0 is the bottom row of the picture (OBJ), whatever the file had.
using CornerUv = std::array<Eigen::Vector2f, 3>;
using CornerColor = std::array<LinearColor, 3>;

struct TriangleMesh {
  std::vector<Vec3> positions;      // mm
  std::vector<Triangle> triangles;  // outward orientation where it could be established

  Box3 bounds() const;
};

// In the model's own frame. How it hangs over the bath is a PosedObject's matter.
struct Object : TriangleMesh {
  std::vector<int> material_of;     // per triangle, index into materials
  std::vector<CornerUv> uvs;        // per triangle, or empty: the model has no UVs
  std::vector<CornerColor> colors;  // per triangle, or empty: no vertex colours
  std::vector<Material> materials;  // never empty
  std::vector<std::shared_ptr<const Image>> textures;

  // Whether the model says which colour goes where: texture with UVs, vertex colours, several
  // materials, or one whose colour the file states, unless that is white. Without it `print` has
  // nothing to print.
  bool has_appearance() const;
  // The colour of all of it, if it has no texture, no vertex colours and one material colour.
  std::optional<LinearColor> one_color() const;
};

// A point on the surface: barycentric weights (1 - u - v, u, v) of a triangle's corners.
struct SurfacePoint {
  int triangle = -1;
  double u = 0;
  double v = 0;
};

Vec3 position_at(const TriangleMesh& mesh, const SurfacePoint& point);
// Along the normal, as long as the triangle's area.
Vec3 area_vector(const std::vector<Vec3>& positions, const Triangle& triangle);
// Unit face normal; zero for a degenerate triangle.
Vec3 face_normal(const TriangleMesh& mesh, int triangle);

// The wanted colour there, in linear light, composited over `base` (the bare object's colour) by
// its alpha; the result is opaque. Textures are sampled bilinearly in linear light at their full
// resolution: callers antialias by supersampling.
LinearColor color_at(const Object& object, const SurfacePoint& point, const LinearColor& base);

}  // namespace hydrodip
