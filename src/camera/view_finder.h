// Where a photo was taken, by what corners of the tank's rim tell and what was known before.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "camera/least_squares.h"
#include "camera/view.h"

namespace hydrodip {

using ViewValues = Eigen::Matrix<double, View::kValues, 1>;

inline constexpr std::size_t kLeastBoardMarks = 8;

struct RimCorner {
  int strip = 0;
  Vec3 at = Vec3::Zero();  // as calibrated
  Vec2 px = Vec2::Zero();
};
using RimCorners = std::vector<RimCorner>;

// Enough of them, on two sides of the tank at least.
bool reaches_around(const RimCorners& corners);

// The point at that height, tank frame, that a pixel sees.
Vec2 on_level(const ViewValues& values, const Vec2& px, double z_mm);

class ViewFinder {
 public:
  // The tank outlives it. `water_sigma_mm`: how well the level is known.
  ViewFinder(const Tank& tank, double water_sigma_mm);

  // From corners that lie in a plane, nearly, with the lens and the level as calibrated.
  Eigen::VectorXd start(const RimCorners& corners) const;
  // Two residuals for each corner come first.
  Fit fit(const RimCorners& corners, const Eigen::VectorXd& from) const;
  // With what scatters more than a corner should.
  static Eigen::MatrixXd covariance(const Fit& fit);

 private:
  Eigen::VectorXd residuals(const Eigen::VectorXd& v, const RimCorners& corners) const;

  const Tank& tank_;
  double water_sigma_mm_;
  Eigen::MatrixXd to_units_;
};

}  // namespace hydrodip
