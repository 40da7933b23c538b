#include <Eigen/SparseCholesky>

#include "elastic/sparse_cholesky_solver.h"

namespace hydrodip {

std::unique_ptr<LinearSolver> make_direct_solver() {
  return std::make_unique<
      SparseCholeskySolver<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>>>();
}

}  // namespace hydrodip
