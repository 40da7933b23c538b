#include "calibrate/synthetic.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace hydrodip {
namespace {

constexpr double kFarthest_mm = 200;

// Not the standard library's distributions, which differ between implementations.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}

  double uniform() { return double(engine_() >> 11) * 0x1p-53; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  Vec3 normal_vector() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }
  Eigen::Isometry3d pose() {
    Eigen::Quaterniond turn(normal(), normal(), normal(), normal());
    turn.normalize();
    Eigen::Isometry3d pose(turn);
    pose.pretranslate(kFarthest_mm * Vec3(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5));
    return pose;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace

CornerGrid synthetic_scan(const GridLanding& landing, const GridPlace& reach,
                          const SyntheticOptions& options) {
  Chance chance(options.seed);
  const Eigen::Isometry3d random_pose = chance.pose();
  const Eigen::Isometry3d pose = options.aligned ? Eigen::Isometry3d::Identity() : random_pose;
  CornerGrid grid;
  for (int row = -reach[1]; row <= reach[1]; ++row)
    for (int column = -reach[0]; column <= reach[0]; ++column) {
      const auto lands = landing({column, row});
      if (!lands) continue;
      const Vec3 noise = options.noise_mm * chance.normal_vector();
      if (chance.uniform() < options.missing_share) continue;
      grid.position.push_back(pose * (*lands + noise));
      grid.place.push_back({column, row});
      grid.patch.push_back(0);
    }
  return grid;
}

}  // namespace hydrodip
