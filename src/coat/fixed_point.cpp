#include "coat/fixed_point.h"

#include "base/dense_solvers.h"

namespace hydrodip {

Eigen::VectorXd FixedPoint::next(const Eigen::VectorXd& x, const Eigen::VectorXd& g) {
  const Eigen::VectorXd residual = g - x;
  const auto columns = Eigen::Index(residuals_.size());
  Eigen::VectorXd result = g;
  if (columns > 0) {
    Eigen::MatrixXd residual_change(x.size(), columns), image_change(x.size(), columns);
    for (Eigen::Index i = 0; i < columns; ++i) {
      residual_change.col(i) = residual - residuals_[std::size_t(i)];
      image_change.col(i) = g - images_[std::size_t(i)];
    }
    result -= image_change * solve_overdetermined(residual_change, residual);
  }
  images_.push_back(g);
  residuals_.push_back(residual);
  if (int(images_.size()) > memory_) {
    images_.erase(images_.begin());
    residuals_.erase(residuals_.begin());
  }
  return result;
}

}  // namespace hydrodip
