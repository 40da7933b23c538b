// A trajectory as one object travels it: measured in millimetres, and cut into moments.
#pragma once

#include <vector>

#include "dip/trajectory.h"

namespace hydrodip {

// Where the object is at one moment, in the sinking frame: the bath's, moved down with the pivot,
// so that the water stands at z = level_mm in it and rises. As long as the object neither shifts
// nor turns, this is the posed-object frame.
struct Moment {
  double travelled_mm = 0;  // on a way straight down: the depth
  double t = 0;             // of the trajectory
  double level_mm = 0;
  bool moved = false;  // whether the object has another place in the sinking frame than in its own
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();

  // Of a way straight down.
  static Moment at_depth(double depth_mm, double t = 0) { return {depth_mm, t, depth_mm}; }

  Vec3 to_sinking(const Vec3& on_object) const {
    return moved ? Vec3(turn * on_object + shift) : on_object;
  }
  Vec3 to_object(const Vec3& sinking) const {
    return moved ? Vec3(turn.transpose() * (sinking - shift)) : sinking;
  }
  // A floating point, seen from above, on the object.
  Vec3 afloat(const Vec2& plan) const { return to_object(Vec3(plan.x(), plan.y(), level_mm)); }
  Vec3 direction_to_sinking(const Vec3& direction) const {
    return moved ? Vec3(turn * direction) : direction;
  }
  // Of a point of the object above the water.
  double height(const Vec3& on_object) const { return sinking_z(on_object) - level_mm; }
  double sinking_z(const Vec3& on_object) const {
    return moved ? turn.row(2).dot(on_object) + shift.z() : on_object.z();
  }
};

// How far the object has travelled is how far its fastest wetted point has: in equal parts of that,
// no wetted point moves further than one part. What happens in the air before the first touch does
// not count.
class Travel {
 public:
  // Throws InputError if the object is in the water at the start, or never gets wet.
  Travel(const Trajectory& trajectory, const std::vector<Vec3>& positions,
         const std::vector<Triangle>& triangles);

  double length_mm() const { return length_; }
  // 0 is the first touch.
  Moment at(double travelled_mm) const;
  const Trajectory& trajectory() const { return trajectory_; }

 private:
  void measure(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

  Trajectory trajectory_;
  double length_ = 0;
  // What has been travelled at some parameters, both ascending; linear between.
  std::vector<double> t_, travelled_;
};

}  // namespace hydrodip
