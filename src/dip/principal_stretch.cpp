#include "dip/principal_stretch.h"

#include <algorithm>
#include <cmath>

#include "elastic/corotated.h"

namespace hydrodip {

// From the metric G = (dX/du)^T (dX/du).
PrincipalStretches principal_stretches(const std::array<Vec2, 3>& flat,
                                       const std::array<Vec3, 3>& placed) {
  const RestTriangle rest = rest_triangle(flat[0], flat[1], flat[2]);
  Eigen::Matrix<double, 3, 2> J = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t k = 0; k < 3; ++k) J += placed[k] * rest.gradient.row(Eigen::Index(k));
  const Mat2 G = J.transpose() * J;
  const double half = 0.5 * G.trace();
  const double apart = std::sqrt(std::max(0.0, half * half - G.determinant()));
  return {std::sqrt(half + apart), std::sqrt(std::max(0.0, half - apart))};
}

}  // namespace hydrodip
