// The only place that knows Eigen's unsupported solvers.
#include "camera/least_squares.h"

#include <Eigen/QR>
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
  fit.covariance = (jacobian.transpose() * jacobian).completeOrthogonalDecomposition().pseudoInverse();
  return fit;
}

}  // namespace hydrodip
