#include "coat/fixed_point.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace hydrodip {
namespace {

// g(x) = A x + b with two eigenvalues; the fixed point is (2, -1).
Eigen::VectorXd linear(const Eigen::VectorXd& x) {
  const Eigen::Vector2d fixed(2, -1);
  Eigen::Matrix2d A;
  A << -1.1, 0.2, 0.1, 0.4;
  return fixed + A * (x - fixed);
}

int evaluations_until_fixed(int memory, int at_most) {
  FixedPoint search(memory);
  Eigen::VectorXd x = Eigen::Vector2d(0, 0);
  for (int n = 1; n <= at_most; ++n) {
    const Eigen::VectorXd g = linear(x);
    if ((g - x).norm() < 1e-9) return n;
    x = search.next(x, g);
  }
  return at_most + 1;
}

// Two secants know everything about a linear map of the plane.
TEST(FixedPoint, EndsALinearIterationThatWouldSwingForever) {
  EXPECT_GT(evaluations_until_fixed(0, 50), 50);
  EXPECT_LE(evaluations_until_fixed(2, 50), 4);
}

// Whatever came before the last two evaluations, the present one goes on from those.
TEST(FixedPoint, ForgetsWhatIsOlderThanItsMemory) {
  const auto point = [](double n) -> Eigen::VectorXd {
    return Eigen::Vector4d(std::sin(n), std::cos(3 * n), std::sin(5 * n), std::cos(7 * n));
  };
  FixedPoint one(2), other(2);
  one.next(point(100), point(101));
  other.next(point(200), point(201));
  for (int n = 0; n < 6; ++n) {
    const Eigen::VectorXd a = one.next(point(n), point(n + 0.5));
    const Eigen::VectorXd b = other.next(point(n), point(n + 0.5));
    EXPECT_EQ((a - b).norm() < 1e-12, n >= 2) << n;
  }
}

TEST(FixedPoint, StaysWhereItHasArrived) {
  FixedPoint search(2);
  const Eigen::VectorXd fixed = Eigen::Vector2d(2, -1);
  for (int i = 0; i < 4; ++i) EXPECT_LT((search.next(fixed, linear(fixed)) - fixed).norm(), 1e-12);
}

}  // namespace
}  // namespace hydrodip
