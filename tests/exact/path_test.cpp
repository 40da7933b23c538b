// Ways into the water other than straight down, against solutions in closed form or as ordinary
// differential equations.
#include <gtest/gtest.h>

#include "exact/paths.h"

namespace hydrodip {
namespace {

using namespace exact;

constexpr double kBar_mm = 0.02;

// The figures of an independent integration, given to about 3e-4 mm.
TEST(PathSolutions, OfARolledCylinder) {
  const RolledCylinder rolled;
  const RolledCylinder::Side right = rolled.solved(1), left = rolled.solved(-1);
  const auto psi = [](double x) { return std::asin(x / 30); };
  EXPECT_NEAR(right.at(psi(10)), 10.1057, 4e-4);
  EXPECT_NEAR(right.at(psi(20)), 21.0843, 4e-4);
  EXPECT_NEAR(right.at(psi(25)), 27.6962, 4e-4);
  EXPECT_NEAR(right.at(psi(29)), 35.3908, 4e-4);
  EXPECT_NEAR(30 * std::sin(right.psi.back()), 29.666, 1e-3);
  EXPECT_NEAR(right.u.back(), 37.791, 1e-3);
  EXPECT_NEAR(left.at(psi(-10)), -10.0518, 4e-4);
  EXPECT_NEAR(left.at(psi(-20)), -20.4025, 4e-4);
  EXPECT_NEAR(left.at(psi(-25)), -25.9272, 4e-4);
  EXPECT_NEAR(left.at(psi(-26)), -27.1259, 4e-4);
}

// Straight down, log((L - u) / (L - x)) is a mere integral over x.
TEST(PathSolutions, OfACylinderStraightDown) {
  const RolledCylinder straight{.shift = 0, .turn = 0};
  const RolledCylinder::Side right = straight.solved(1), left = straight.solved(-1);
  for (const double x : {5.0, 10.0, 20.0, 25.0}) {
    constexpr int kParts = 20000;
    double sum = 0;
    for (int n = 0; n < kParts; ++n) {
      const double at = (n + 0.5) * x / kParts;
      sum += std::hypot(1, kZStretch * at / std::sqrt(900 - at * at)) / (95 - at) * x / kParts;
    }
    const double u = 95 - 95 * std::exp(-sum), psi = std::asin(x / 30);
    EXPECT_NEAR(right.at(psi), u, 1e-5);
    EXPECT_NEAR(left.at(-psi), -u, 1e-5);
  }
}

TEST(PathSolutions, OfATwistedSphere) {
  const auto tan_theta = [](double a) { return a / std::sqrt(900 - a * a); };
  const RevolutionTable u(28.4, kZStretch, tan_theta);
  const std::vector<double> v = twisted({10, 20, 28}, kClampRadius, kZStretch, tan_theta, u,
                                        [](double a) { return 2 * kDegree * a / 28; });
  EXPECT_NEAR(v[0], -0.0413, 1e-4);
  EXPECT_NEAR(v[1], -0.1618, 1e-4);
  EXPECT_NEAR(v[2], -0.2958, 1e-4);
}

TEST(PathSlow, RolledCylinderMeetsTheBarByDefault) {
  const PathError error = rolled_cylinder_error({}, 40000);
  EXPECT_LE(error.largest_mm, kBar_mm);
  EXPECT_GT(error.reach_mm, 38);
  EXPECT_GT(error.vertices, 3000);
}

TEST(PathSlow, TwistedSphereMeetsTheBarByDefault) {
  const PathError error = twisted_sphere_error(2, 40000);
  EXPECT_LE(error.largest_mm, kBar_mm);
  EXPECT_GT(error.reach_mm, 27.5);
  EXPECT_GT(error.vertices, 3000);
}

}  // namespace
}  // namespace hydrodip
