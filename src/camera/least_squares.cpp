// The only place that knows MINPACK.
#include "camera/least_squares.h"

#include <cminpack.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include "base/eigenpairs.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

// MINPACK is C and sees no exceptions: the first one stops it and is thrown afterwards.
struct Problem {
  const Residuals& residuals;
  std::exception_ptr failure;

  static int call(void* self, int values, int inputs, const double* x, double* out,
                  double* jacobian, int stride, int wanted);
};

constexpr int kWantsResiduals = 1;
constexpr int kStop = -1;

// By central differences; for unknowns of any size. A step of one that is nearly 0 must not be lost
// in what it is added to.
Eigen::MatrixXd slope(const Residuals& residuals, Eigen::VectorXd x, Eigen::Index values) {
  static const double kStep = std::cbrt(std::numeric_limits<double>::epsilon());
  constexpr double kNearlyZero = 1e-4;
  Eigen::MatrixXd j(values, x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    check_cancelled();
    const double at = x[k];
    const double step = at == 0 ? kStep : kStep * std::max(std::abs(at), kNearlyZero);
    x[k] = at + step;
    j.col(k) = residuals(x);
    x[k] = at - step;
    j.col(k) = (j.col(k) - residuals(x)) / (2 * step);
    x[k] = at;
  }
  return j;
}

int Problem::call(void* self, int values, int inputs, const double* x, double* out,
                  double* jacobian, int stride, int wanted) {
  Problem& problem = *static_cast<Problem*>(self);
  const Eigen::Map<const Eigen::VectorXd> guess(x, inputs);
  try {
    check_cancelled();
    if (wanted == kWantsResiduals)
      Eigen::Map<Eigen::VectorXd>(out, values) = problem.residuals(guess);
    else
      Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(jacobian, values, inputs,
                                                           Eigen::OuterStride<>(stride)) =
          slope(problem.residuals, guess, values);
  } catch (...) {
    problem.failure = std::current_exception();
    return kStop;
  }
  return 0;
}

Eigen::VectorXd minimized(const Residuals& residuals, Eigen::VectorXd x) {
  constexpr double kTolerance = 1e-12;
  constexpr int kMostCalls = 4000;
  constexpr int kOwnScale = 1;
  constexpr double kFirstStep = 100;  // MINPACK's advice
  const auto n = int(x.size());
  const auto m = int(residuals(x).size());
  Problem problem{residuals, nullptr};
  Eigen::VectorXd out(m), scale(n), qtf(n), work_1(n), work_2(n), work_3(n), work_4(m);
  Eigen::MatrixXd jacobian(m, n);
  std::vector<int> pivots(std::size_t(n), 0);
  int calls = 0;
  int slopes = 0;
  lmder(Problem::call, &problem, m, n, x.data(), out.data(), jacobian.data(), m, kTolerance,
        kTolerance, 0, kMostCalls, scale.data(), kOwnScale, kFirstStep, 0, &calls, &slopes,
        pivots.data(), qtf.data(), work_1.data(), work_2.data(), work_3.data(), work_4.data());
  if (problem.failure) std::rethrow_exception(problem.failure);
  return x;
}

// In units in which the diagonal is 1; what nothing tells gets a variance that says so.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd unit = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigenpairs eigen = eigenpairs(unit.asDiagonal() * normal * unit.asDiagonal());
  constexpr double kNothing = 1e-13;
  const Eigen::VectorXd inverse = eigen.values.cwiseMax(kNothing).cwiseInverse();
  const Eigen::MatrixXd& v = eigen.vectors;
  return unit.asDiagonal() * (v * inverse.asDiagonal() * v.transpose()) * unit.asDiagonal();
}

}  // namespace

Fit least_squares(const Residuals& residuals, const Eigen::VectorXd& start) {
  Fit fit;
  fit.values = minimized(residuals, start);
  fit.residuals = residuals(fit.values);
  const Eigen::MatrixXd j = slope(residuals, fit.values, fit.residuals.size());
  fit.covariance = inverse_of(j.transpose() * j);
  return fit;
}

}  // namespace hydrodip
