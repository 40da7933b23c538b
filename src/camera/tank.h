// A tank as a camera knows it: the lens, and where the marks on the rim lie.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/context.h"
#include "camera/lens.h"
#include "tags/seen_marks.h"

namespace hydrodip {

// Where the film is to lie: its middle, and how it is turned counter-clockwise, in the tank frame.
struct FilmPlace {
  Vec2 middle_mm = Vec2::Zero();
  double turn_deg = 0;
};

// The tank frame: mm, z up, z = 0 the plane through the rim's marks as well as it can be, the
// origin in the middle of them, x along the strip of the lowest number.
struct Tank {
  int width_px = 0, height_px = 0;  // of its photos
  Lens lens;
  Eigen::Matrix<double, Lens::kValues, Lens::kValues> lens_covariance =
      Eigen::Matrix<double, Lens::kValues, Lens::kValues>::Zero();
  double rms_px = 0;              // of the calibration
  std::map<int, Vec3> corner_mm;  // of the board's marks, by tag
  FilmPlace place;
  double water_below_mm = 0;  // the water under z = 0
};

// One photo's marks.
struct SeenPhoto {
  std::string name;
  std::vector<SeenMark> marks;
};

// Lens and rim from photos of the empty tank, all of one size and taken from different sides (a
// bundle adjustment: all camera poses, all strips' poses and the lens together). Throws InputError
// if strips are not seen well enough, nothing fits, or the photos are too much alike to tell the
// lens by. Photos that do not help are left out, with a warning.
Tank calibrate_tank(const std::vector<SeenPhoto>& photos, int width_px, int height_px,
                    const RunContext& context);

// Where a photo of that tank was taken: tank frame to camera frame, the lens as it was then and how
// far the water stood under the marks, each with what is known of it before.
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
