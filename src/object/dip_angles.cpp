#include "object/dip_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydrodip {

double dip_angle_deg(const Vec3& normal, const Vec3& direction) {
  return std::acos(std::clamp(normal.dot(direction), -1.0, 1.0)) * 180 / std::numbers::pi;
}

DippingDirection straight_down_to(double depth_mm) {
  return [depth_mm](const Vec3& point, double slack_mm) -> std::optional<Vec3> {
    if (point.z() > depth_mm + slack_mm) return std::nullopt;
    return Vec3(0, 0, -1);
  };
}

DipAngles dip_angles(const TriangleMesh& posed, double depth_mm) {
  return dip_angles(posed, straight_down_to(depth_mm));
}

DipAngles dip_angles(const TriangleMesh& posed, const DippingDirection& direction_at) {
  DipAngles angles;
  for (const Triangle& triangle : posed.triangles) {
    const Vec3& a = posed.positions[static_cast<std::size_t>(triangle[0])];
    const Vec3& b = posed.positions[static_cast<std::size_t>(triangle[1])];
    const Vec3& c = posed.positions[static_cast<std::size_t>(triangle[2])];
    const auto direction = direction_at((a + b + c) / 3, 0);
    if (!direction) continue;
    const Vec3 doubled = (b - a).cross(c - a);
    const double area = 0.5 * doubled.norm();
    if (!(area > 0)) continue;
    const double angle = dip_angle_deg(doubled.normalized(), *direction);
    if (!faces_down(angle)) {
      angles.upward_mm2 += area;
      continue;
    }
    angles.downward_mm2 += area;
    angles.area_mm2[static_cast<std::size_t>(std::min(angle / 10, DipAngles::kBins - 1.0))] += area;
    if (beyond_dip_limit(angle)) angles.over_limit_mm2 += area;
  }
  return angles;
}

}  // namespace hydrodip
