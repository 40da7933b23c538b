// Vector and matrix names used everywhere. Lengths are millimetres unless a name says otherwise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>

namespace hydrodip {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

// Three vertex indices, counter-clockwise seen from outside (object) or from above (film).
using Triangle = std::array<std::int32_t, 3>;

constexpr double kMmPerInch = 25.4;
constexpr double kMmPerPt = kMmPerInch / 72;
constexpr double kDegree = std::numbers::pi / 180;  // in radians

// z component of a x b: twice the signed area of the triangle (0, a, b).
inline double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Box2 {
  Vec2 min = Vec2::Constant(1e300);
  Vec2 max = Vec2::Constant(-1e300);
  void add(const Vec2& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  bool empty() const { return min.x() > max.x(); }
};

struct Box3 {
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);
  void add(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  bool empty() const { return min.x() > max.x(); }
  Vec3 size() const { return max - min; }
  Vec3 center() const { return 0.5 * (min + max); }
};

}  // namespace hydrodip
