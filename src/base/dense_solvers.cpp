#include "base/dense_solvers.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

namespace hydrodip {

struct MinimumNorm::Factors : Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> {};

MinimumNorm::MinimumNorm(const Eigen::MatrixXd& matrix, double threshold) {
  auto factors = std::make_shared<Factors>();
  if (threshold > 0) factors->setThreshold(threshold);
  factors->compute(matrix);
  factors_ = std::move(factors);
}

Eigen::VectorXd MinimumNorm::solve(const Eigen::VectorXd& right) const {
  return factors_->solve(right);
}

Eigen::MatrixXd MinimumNorm::pseudo_inverse() const { return factors_->pseudoInverse(); }

Eigen::VectorXd solve_overdetermined(const Eigen::MatrixXd& tall, const Eigen::VectorXd& right) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(tall).solve(right);
}

Eigen::MatrixXd column_space(const Eigen::MatrixXd& columns, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns.rows(), columns.cols());
  qr.setThreshold(threshold);
  qr.compute(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& tall) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(tall)
      .matrixQR()
      .topRows(tall.cols())
      .triangularView<Eigen::Upper>();
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
  return matrix.partialPivLu().inverse();
}

}  // namespace hydrodip
