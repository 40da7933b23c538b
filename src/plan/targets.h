// Points that stand for the object's surface where ways to dip it are compared, and how much each
// of them matters.
#pragma once

#include <vector>

#include "object/object.h"
#include "object/paint.h"
#include "object/posed_object.h"

namespace hydrodip {

struct Target {
  SurfacePoint point;
  Vec3 position;    // in the mesh's frame
  Vec3 normal;      // unit, outward
  double area = 0;  // of the surface that it stands for, in the mesh's unit squared
  double importance = 1;
};

struct Targets {
  std::vector<Target> list;
  double area = 0;    // sum over all
  double weight = 0;  // sum of area times importance; above 0 if there is any surface
};

inline constexpr int kTargets = 4000;

// Differences in CIELAB that count in full, from the bare object and around a point.
inline constexpr double kFullColor = 25, kFullDetail = 15;

// Evenly over the surface, about `count` of them and always the same ones: equal shares of area,
// and in each triangle the points of a low-discrepancy sequence.
Targets spread_targets(const TriangleMesh& mesh, int count = kTargets);

// A target of a model's mesh, in the posed-object frame. The area stays the model's.
Target in_pose(const Target& target, const PosedObject& posed);

// Weighs them by what is wanted there: most where a colour differs from the bare object's or where
// there is detail; a quarter of that where the bare object would look right, and less where that is
// so much that it would weigh more than a third of the rest.
void weigh_by_paint(Targets& targets, const Paint& paint);

// Weighs them by a picture's lightness (linear): white counts in full, black not at all. Throws
// InputError if it is black wherever it meets the object.
void weigh_by_picture(Targets& targets, const Paint& picture);

}  // namespace hydrodip
