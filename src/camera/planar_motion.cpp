#include "camera/planar_motion.h"

#include <Eigen/Geometry>
#include <cmath>

#include "camera/corner_fit.h"

namespace hydrodip {

Vec2 PlanarMotion::operator*(const Vec2& point) const {
  return Eigen::Rotation2Dd(turn) * point + Vec2(x, y);
}

PlanarMotion planar_fit(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += from[i] / double(from.size());
    b += to[i] / double(from.size());
  }
  double dot = 0, cross = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    dot += (from[i] - a).dot(to[i] - b);
    cross += cross2(from[i] - a, to[i] - b);
  }
  const double turn = std::atan2(cross, dot);
  const Vec2 shift = b - Eigen::Rotation2Dd(turn) * a;
  return {shift.x(), shift.y(), turn};
}

PlanarMotion median_of(const std::vector<PlanarMotion>& all) {
  std::vector<double> x, y, cosine, sine;
  for (const PlanarMotion& p : all) {
    x.push_back(p.x);
    y.push_back(p.y);
    cosine.push_back(std::cos(p.turn));
    sine.push_back(std::sin(p.turn));
  }
  return {median(x), median(y), std::atan2(median(sine), median(cosine))};
}

}  // namespace hydrodip
