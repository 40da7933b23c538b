// Pictures that lie where the model's texture coordinates have them.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "artwork/placement.h"
#include "base/error.h"

namespace hydrodip {
namespace {

// How long a texture's side is on the surface, on average, in mm.
double side_mm(const Object& object, const TriangleMesh& mesh) {
  double surface = 0, texture = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    const Vec3& a = mesh.positions[std::size_t(v[0])];
    const CornerUv& uv = object.uvs[t];
    surface +=
        (mesh.positions[std::size_t(v[1])] - a).cross(mesh.positions[std::size_t(v[2])] - a).norm();
    texture += std::abs(cross2((uv[1] - uv[0]).cast<double>(), (uv[2] - uv[0]).cast<double>()));
  }
  const double side = texture > 0 ? std::sqrt(surface / texture) : 1;
  return std::isfinite(side) && side > 0 ? side : 1;
}

class ByUv : public Placement {
 public:
  ByUv(const Object& object, double side_mm) : object_(object), side_(side_mm) {}
  bool find(const SurfacePoint& point, Spot& spot) const override {
    const CornerUv& uv = object_.uvs[std::size_t(point.triangle)];
    // Faces without coordinates among others that have them.
    if (uv[0].isZero(0) && uv[1].isZero(0) && uv[2].isZero(0)) return false;
    const Vec2 there = (1 - point.u - point.v) * uv[0].cast<double>() +
                       point.u * uv[1].cast<double>() + point.v * uv[2].cast<double>();
    spot = {side_ * (there - Vec2(0.5, 0.5)), 1};
    return true;
  }

 private:
  const Object& object_;
  double side_;
};

}  // namespace

Placed place_by_uv(const PlacementTask& task) {
  const Object& object = task.posed.object();
  if (object.uvs.empty())
    throw InputError(
        fmt::format("{}: the model has no texture coordinates (UVs) to lay artwork by; another "
                    "--projection, as "
                    "planar or wrap, needs none",
                    name_of(task.layer)));
  const double side = side_mm(object, task.posed.mesh());
  return {std::make_unique<ByUv>(object, side), {side, side}, task.layer};
}

}  // namespace hydrodip
