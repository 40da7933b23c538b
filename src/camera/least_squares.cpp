// The only place that knows Eigen's unsupported solvers.
#include "camera/least_squares.h"

#include <Eigen/Eigenvalues>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

struct Problem {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const Residuals& residuals;
  Eigen::Index number_of_inputs, number_of_values;

  int inputs() const { return int(number_of_inputs); }
  int values() const { return int(number_of_values); }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& out) const {
    check_cancelled();
    out = residuals(x);
    return 0;
  }
};

// In units in which the diagonal is 1; what nothing tells gets a variance that says so.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd unit = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.asDiagonal() * normal *
                                                             unit.asDiagonal());
  constexpr double kNothing = 1e-13;
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(kNothing).cwiseInverse();
  const Eigen::MatrixXd& v = eigen.eigenvectors();
  return unit.asDiagonal() * (v * inverse.asDiagonal() * v.transpose()) * unit.asDiagonal();
}

using Differentiable = Eigen::NumericalDiff<Problem, Eigen::Central>;

}  // namespace

Fit least_squares(const Residuals& residuals, const Eigen::VectorXd& start) {
  Fit fit;
  fit.values = start;
  const Differentiable problem(Problem{residuals, start.size(), residuals(start).size()});
  Differentiable solved = problem;
  Eigen::LevenbergMarquardt<Differentiable> solver(solved);
  solver.parameters.ftol = solver.parameters.xtol = 1e-12;
  solver.parameters.maxfev = 4000;
  solver.minimize(fit.values);
  fit.residuals = residuals(fit.values);
  Eigen::MatrixXd jacobian(fit.residuals.size(), start.size());
  problem.df(fit.values, jacobian);
  fit.covariance = inverse_of(jacobian.transpose() * jacobian);
  return fit;
}

}  // namespace hydrodip
