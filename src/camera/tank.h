// A tank as a camera knows it: the lens, and where the marks on the rim lie.
#pragma once

#include <map>
#include <vector>

#include "base/context.h"
#include "camera/lens.h"
#include "camera/seen_photo.h"

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

// Lens and rim from photos of the empty tank, all of one size and taken from different sides (a
// bundle adjustment: all camera poses, all strips' poses and the lens together). Throws InputError
// if strips are not seen well enough, nothing fits, or the photos are too much alike to tell the
// lens by. Photos that do not help are left out, with a warning.
Tank calibrate_tank(const std::vector<SeenPhoto>& photos, int width_px, int height_px,
                    const RunContext& context);

}  // namespace hydrodip
