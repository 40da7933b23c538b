// Of symmetric matrices, compiled once: Eigen's own solver takes seconds to compile for every size.
#pragma once

#include <Eigen/Core>

namespace hydrodip {

struct Eigenpairs {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // a column for each, of length 1
};

// Only the lower triangle of the matrix is read.
Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

}  // namespace hydrodip
