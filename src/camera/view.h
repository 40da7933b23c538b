// Where a photo of a tank was taken from.
#pragma once

#include <Eigen/Core>

#include "camera/lens.h"
#include "camera/seen_photo.h"
#include "camera/tank.h"

namespace hydrodip {

// Tank frame to camera frame, the lens as it was then and how far the water stood under the marks,
// each with what is known of it before.
struct View {
  static constexpr int kValues = Pose::kValues + Lens::kValues + 1;
  Eigen::Matrix<double, kValues, 1> values;  // pose, lens, water_below_mm
  Eigen::Matrix<double, kValues, kValues> covariance;
  double rms_px = 0;  // of the board's marks
  int board_marks = 0;

  // The point of the water's surface that a pixel sees, tank frame.
  static Vec2 on_water(const Eigen::Matrix<double, kValues, 1>& values, const Vec2& px);
};

// Throws InputError naming the photo: too few marks of the rim, a strip that is to be seen twice,
// one that has moved as a whole (by more than 0.3 mm, if the others can tell), or marks that fit
// the rim much worse than the calibration's. water_sigma_mm: how well the level is known.
View view_of(const SeenPhoto& photo, const Tank& tank, double water_sigma_mm);

}  // namespace hydrodip
