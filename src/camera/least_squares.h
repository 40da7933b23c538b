// Small nonlinear fits.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace hydrodip {

// Residuals, each in units of its standard deviation, of a guess.
using Residuals = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct Fit {
  Eigen::VectorXd values;
  Eigen::VectorXd residuals;
  // Of the values, if the residuals' deviations are as they were said to be.
  Eigen::MatrixXd covariance;
};

// The values that make the sum of squares least, from a start that is near (Levenberg and
// Marquardt, with derivatives by differences). At least as many residuals as values.
Fit least_squares(const Residuals& residuals, const Eigen::VectorXd& start);

}  // namespace hydrodip
