#include "elastic/cholmod_solver.h"

#include <Eigen/CholmodSupport>

#include "elastic/sparse_cholesky_solver.h"

namespace hydrodip {

std::unique_ptr<LinearSolver> make_cholmod_solver() {
  return std::make_unique<SparseCholeskySolver<
      Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower>>>();
}

}  // namespace hydrodip
