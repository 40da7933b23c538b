#include "calibrate/kit_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "calibrate/tear_limit.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr int kAround = 256;     // corners of an outline; a square's corners are among them
constexpr int kRings = 96;       // from the lowest point to the equator
constexpr double kBody_mm = 18;  // straight, above the shape

// An outline, in the directions of kAround rays from the axis.
using Outline = std::vector<Vec2>;
using MakePoint = std::function<Vec2(const Vec2& direction)>;

Outline outline(const MakePoint& point) {
  Outline result;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    result.push_back(point({std::cos(angle), std::sin(angle)}));
  }
  return result;
}

// Stacks outlines into a closed surface, from its lowest point up, down into the hole and to the
// hole's bottom.
class Stack {
 public:
  explicit Stack(const Vec3& tip) { object_.positions.push_back(tip); }

  void add(const Outline& ring, double z) {
    const auto first = std::int32_t(object_.positions.size());
    for (const Vec2& p : ring) object_.positions.push_back({p.x(), p.y(), z});
    for (std::int32_t i = 0; i < kAround; ++i) {
      const std::int32_t next = (i + 1) % kAround;
      if (last_ < 0) {
        object_.triangles.push_back({0, first + next, first + i});
      } else {
        object_.triangles.push_back({last_ + i, last_ + next, first + next});
        object_.triangles.push_back({last_ + i, first + next, first + i});
      }
    }
    last_ = first;
  }

  Object close(const Vec3& end) {
    const auto center = std::int32_t(object_.positions.size());
    object_.positions.push_back(end);
    for (std::int32_t i = 0; i < kAround; ++i)
      object_.triangles.push_back({last_ + i, last_ + (i + 1) % kAround, center});
    return object_;
  }

 private:
  Object object_;
  std::int32_t last_ = -1;
};

Object with_mount(Stack stack, const Outline& widest, double height_mm) {
  const double top = height_mm + kBody_mm;
  const Outline hole = outline([](const Vec2& d) -> Vec2 { return 0.5 * kMountHole_mm * d; });
  stack.add(widest, top);
  stack.add(hole, top);
  stack.add(hole, top - kMountHoleDepth_mm);
  return stack.close({0, 0, top - kMountHoleDepth_mm});
}

Object round_shape(const Vec3& semi_axes_mm) {
  const auto ellipse = [&](double share) {
    return outline(
        [&](const Vec2& d) -> Vec2 { return share * d.cwiseProduct(semi_axes_mm.head<2>()); });
  };
  Stack stack(Vec3::Zero());
  for (int k = 1; k <= kRings; ++k) {
    const double angle = 0.5 * std::numbers::pi * k / kRings;
    stack.add(ellipse(std::sin(angle)), semi_axes_mm.z() * (1 - std::cos(angle)));
  }
  return with_mount(std::move(stack), ellipse(1), semi_axes_mm.z());
}

Object pyramid_shape(double base_mm, double height_mm) {
  const Outline square =
      outline([&](const Vec2& d) -> Vec2 { return 0.5 * base_mm / d.cwiseAbs().maxCoeff() * d; });
  Stack stack(Vec3::Zero());
  stack.add(square, height_mm);
  return with_mount(std::move(stack), square, height_mm);
}

// Outlines of the dome from its lowest point up: smooth, with a groove at every ring.
Object grooved_dome() {
  constexpr double kGroove_mm = 0.25, kHalfWidth_mm = 0.2, kHalfWidthOfFifth_mm = 0.4;
  constexpr double kEdge_mm = 0.1, kFirst_mm = 1, kMargin_mm = 1;
  struct Point {
    double arc_mm, deep_mm;
  };
  std::vector<Point> profile;
  const double before = ring_arc_mm(1) - kMargin_mm;
  for (int i = 1; i <= int(before / kFirst_mm); ++i) profile.push_back({kFirst_mm * i, 0});
  for (int ring = 1; ring <= kDomeRings; ++ring) {
    const double half = ring % 5 == 0 ? kHalfWidthOfFifth_mm : kHalfWidth_mm;
    const double arc = ring_arc_mm(ring);
    profile.insert(profile.end(), {{arc - half - kEdge_mm, 0},
                                   {arc - half, kGroove_mm},
                                   {arc + half, kGroove_mm},
                                   {arc + half + kEdge_mm, 0}});
  }
  const double end = kDomeRadius_mm * std::acos(1 - (kDomeDepth_mm + 2) / kDomeRadius_mm);
  profile.push_back({end, 0});
  const auto circle = [](double radius_mm) {
    return outline([&](const Vec2& d) -> Vec2 { return radius_mm * d; });
  };
  Stack stack(Vec3::Zero());
  for (const Point& point : profile) {
    const double angle = point.arc_mm / kDomeRadius_mm, r = kDomeRadius_mm - point.deep_mm;
    stack.add(circle(r * std::sin(angle)), kDomeRadius_mm - r * std::cos(angle));
  }
  return with_mount(std::move(stack), circle(kDomeRadius_mm * std::sin(end / kDomeRadius_mm)),
                    kDomeDepth_mm + 2);
}

// Half a turn about x: the flat end comes down.
void stand_on_mount(Object& object) {
  const double top = object.bounds().max.z();
  for (Vec3& p : object.positions) p = Vec3(p.x(), -p.y(), top - p.z());
}

}  // namespace

Object kit_shape(const KitShape& shape) {
  // The simulated mesh's own size, so that a printed shape and its simulation cannot drift apart.
  const Box3 box = mesh_of(shape).bounds();
  Object object = std::string(shape.sample) == "pyramid"
                      ? pyramid_shape(box.size().x(), box.size().z())
                      : round_shape(0.5 * box.size());
  stand_on_mount(object);
  return object;
}

Object dome_to_print() {
  Object dome = grooved_dome();
  stand_on_mount(dome);
  return dome;
}

}  // namespace hydrodip
