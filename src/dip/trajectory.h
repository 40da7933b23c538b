// The object's way into the water: a rigid motion in the bath. docs/model.md, section 1.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/math.h"

namespace hydrodip {

// Where the object is in the bath: X = R (P - pivot) + pivot + (shift_x, shift_y, -lower) with
// R = Rz Ry Rx, for a point P in the posed-object frame. The water surface is X.z = 0.
struct Keyframe {
  double lower_mm = 0;
  double shift_x_mm = 0, shift_y_mm = 0;
  double turn_x_deg = 0, turn_y_deg = 0, turn_z_deg = 0;
};

// An immutable value. The parameter t runs from 0 to 1 and has no meaning in time: film is in
// equilibrium at every moment, so how fast an object goes does not matter. Keyframes are evenly
// spread over t. (By the way that they cover, the same trajectory would run otherwise for every
// object.)
class Trajectory {
 public:
  // From the first touch of an object in the posed-object frame.
  static Trajectory straight_down(double depth_mm);
  // Linear between the keyframes. Throws InputError for fewer than two of them, and for numbers
  // that are not finite.
  static Trajectory through(std::vector<Keyframe> keyframes, const Vec3& pivot_mm = Vec3::Zero());

  Keyframe at(double t) const;
  Eigen::Isometry3d bath_from_object(double t) const;

  // Only ever down, without any shift or turn, from a start at or above the water.
  bool is_straight_down() const { return straight_; }
  // How far the pivot is lowered in the end.
  double depth_mm() const { return keyframes_.back().lower_mm; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const Vec3& pivot_mm() const { return pivot_; }

 private:
  Trajectory(std::vector<Keyframe> keyframes, const Vec3& pivot_mm);

  std::vector<Keyframe> keyframes_;
  Vec3 pivot_;
  bool straight_;
};

// What is asked of the way in: a path, or straight down, perhaps tilted or rolled.
struct TrajectoryOptions {
  double depth_mm = 0;  // of the lowest point, in the end; 0: until the object is below the water
  std::vector<Keyframe> path = {};  // not empty: this, and nothing of what follows but the pivot
  // The object leans over by tilt_deg and comes down like that, or leans over by roll_deg more
  // while it comes down; its top goes towards the direction tilt_toward_deg from +x to +y.
  double tilt_deg = 0, tilt_toward_deg = 0, roll_deg = 0;
  Vec3 pivot_mm = Vec3::Zero();  // of a path's turns
};

// For an object with these vertices. A tilted object is moved so that what it covers of the film,
// on its way, lies in the film's middle. It is never lowered further than until its top is below
// the water. Throws InputError.
Trajectory make_trajectory(const TrajectoryOptions& options, const std::vector<Vec3>& positions);

}  // namespace hydrodip
