// Faster fixed points: Anderson's acceleration (D. G. Anderson, "Iterative procedures for nonlinear
// integral equations", 1965) of x = g(x) for a costly g.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydrodip {

class FixedPoint {
 public:
  // Remembers so many evaluations of g before the last one.
  explicit FixedPoint(int memory) : memory_(memory) {}

  // Where to evaluate g next, now that g(x) is known: of all mixtures of the remembered points the
  // one at which g(x) - x would be smallest if g were linear, moved on by that difference. g(x)
  // itself as long as nothing is remembered.
  Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

 private:
  int memory_;
  std::vector<Eigen::VectorXd> images_, residuals_;  // g(x) and g(x) - x, the latest last
};

}  // namespace hydrodip
