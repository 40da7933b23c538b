// Dense factorisations of matrices of any size, compiled once: every size of its own costs seconds.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace hydrodip {

// Least squares, and of all solutions the shortest.
class MinimumNorm {
 public:
  // Directions below `threshold` of the largest count as none; 0: those lost in rounding.
  explicit MinimumNorm(const Eigen::MatrixXd& matrix, double threshold = 0);
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd pseudo_inverse() const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

// Least squares of a tall matrix whose columns may depend on each other.
Eigen::VectorXd solve_overdetermined(const Eigen::MatrixXd& tall, const Eigen::VectorXd& right);

// Orthonormal columns that span the same space but for what is below `threshold` of the largest.
Eigen::MatrixXd column_space(const Eigen::MatrixXd& columns, double threshold);

// The square upper triangle R of a matrix QR with at least as many rows as columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& tall);

// Of a symmetric matrix that is not singular.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

// Of a square matrix that is not singular.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

}  // namespace hydrodip
