#include "camera/least_squares.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

// A line through points far from the origin: how well it is known does not depend on where it lies.
TEST(LeastSquares, WhatEndsNearlyAtZeroIsKnownAsWellAsAnythingElse) {
  const auto fit_to = [](double height) {
    return least_squares(
        [height](const Eigen::VectorXd& v) {
          Eigen::VectorXd off(20);
          for (int i = 0; i < 20; ++i) {
            const double x = 10.0 * i - 95;
            off[i] = (v[0] + v[1] * x) - (height + 0.5 * x);
          }
          return off;
        },
        Eigen::Vector2d(height, 0.5));
  };
  for (const double height : {3.0, 1e-3, 1e-7, 1e-12, -1e-16, 0.0}) {
    const Fit fit = fit_to(height);
    EXPECT_NEAR(fit.values[0], height, 1e-9);
    EXPECT_NEAR(fit.covariance(0, 0), 1.0 / 20, 1e-4) << height;
    EXPECT_NEAR(fit.covariance(1, 1), 1 / 66500.0, 1e-7) << height;
  }
}

}  // namespace
}  // namespace hydrodip
