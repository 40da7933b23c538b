// The foot of a mesh edge that crosses the contact line, and the film laid down behind it.
#pragma once

#include "dip/waterline.h"

namespace hydrodip {

// A gradient du/dX that is followed over the steps.
struct Gradient {
  Mat2 now = Mat2::Identity(), before = Mat2::Identity();
  // Extrapolated by a step that is `ratio` times the last one.
  Mat2 next(double ratio) const { return now + ratio * (now - before); }
  void advance(const Mat2& F) {
    before = now;
    now = F;
  }
};

// The gradient that a ghost is placed with: as the film ahead of the foot is expected to be. That
// depends on where the ghost is, the more the further the foot has come, at the end one to one, and
// round an edge of the object by more: there, errors would grow from step to step.
struct GhostGradient {
  Mat2 now = Mat2::Identity();
  Mat2 change_per_mm = Mat2::Zero();  // on average along the way, the later the more

  // The foot went last_mm of way_mm so far, which is `share` of its way to the floating vertex. At
  // first what is expected is taken as it is. Where the foot has nearly arrived it is followed
  // over a tenth of the way, whatever the step, from where the change so far leads: what changes
  // evenly is not late.
  void follow(const Mat2& expected, double last_mm, double way_mm, double share);
};

// Of the edge from an attached vertex to a floating one (docs/model.md, section 4).
struct Foot {
  std::int32_t attached = -1, floating = -1;
  bool inside_out = false;      // the object's faces are turned the wrong way
  Vec3 point = Vec3::Zero();    // on the contact line, between the two; posed-object frame
  Vec2 place = Vec2::Zero();    // the same, seen from above, now
  Vec2 outward = Vec2::Zero();  // from the object, unit, normal to the contact line
  double steepness = 0;         // of the object there
  Vec2 laid = Vec2::Zero();  // film between the attached vertex and the point, in film coordinates
  Vec2 way = Vec2::Zero();   // the same on the object, unrolled into the water plane
  Gradient element;          // du/dX of the floating triangles on both sides of the edge
  Vec2 last_way = Vec2::Zero();      // way of the present step
  Vec2 laid_before = Vec2::Zero();   // laid at its start
  Mat2 expected = Mat2::Identity();  // du/dX at the step's end, extrapolated
  GhostGradient ghost_gradient;
  Vec2 ghost = Vec2::Zero(), ghost_before = Vec2::Zero();  // now, and at the step's start
};

// Whether a gradient can be inverted and means something.
bool usable_gradient(const Mat2& F);

// The way from a point on the object to the contact line at `to` (at the height to_z), unrolled
// into the water plane with the vertical scaled by z_stretch. At the point the object faces
// first_outward (unit, in the water plane; zero where it is flat) and rises at first_slope.
Vec2 unrolled(const Vec3& from, const Vec2& first_outward, double first_slope,
              const Waterline::Point& to, double to_z, double z_stretch);

// Rise over run of a surface with this normal, in a direction of the water plane; kWall at most.
double steepness_along(const Vec3& normal, const Vec2& direction);

// Sets foot.ghost: where the attached vertex would be if the film laid behind the foot were flat
// and strained by its ghost's gradient.
void place_ghost(Foot& foot);

}  // namespace hydrodip
