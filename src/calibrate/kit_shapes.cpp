#include "calibrate/kit_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "calibrate/rounded_pyramid.h"
#include "calibrate/tear_limit.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr int kAround = 256;     // corners of a round outline
constexpr int kRings = 96;       // from the lowest point to the equator
constexpr double kBody_mm = 18;  // straight, above the shape

// Counterclockwise from above, about the axis.
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

// Stacks outlines of as many corners each into a closed surface, from its lowest point, or from a
// side's rim, up, down into the hole and to the hole's bottom.
class Stack {
 public:
  explicit Stack(const Vec3& tip) { object_.positions.push_back(tip); }
  Stack(const TriangleMesh& side, std::vector<std::int32_t> rim) : last_(std::move(rim)) {
    object_.positions = side.positions;
    object_.triangles = side.triangles;
  }

  void add(const Outline& ring, double z) {
    std::vector<std::int32_t> corners;
    for (const Vec2& p : ring) {
      corners.push_back(std::int32_t(object_.positions.size()));
      object_.positions.push_back({p.x(), p.y(), z});
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::size_t next = (i + 1) % corners.size();
      if (last_.empty()) {
        object_.triangles.push_back({0, corners[next], corners[i]});
      } else {
        object_.triangles.push_back({last_[i], last_[next], corners[next]});
        object_.triangles.push_back({last_[i], corners[next], corners[i]});
      }
    }
    last_ = std::move(corners);
  }

  Object close(const Vec3& end) {
    const auto center = std::int32_t(object_.positions.size());
    object_.positions.push_back(end);
    for (std::size_t i = 0; i < last_.size(); ++i)
      object_.triangles.push_back({last_[i], last_[(i + 1) % last_.size()], center});
    return object_;
  }

 private:
  Object object_;
  std::vector<std::int32_t> last_;
};

Object with_mount(Stack stack, const Outline& widest, double height_mm) {
  const double top = height_mm + kBody_mm;
  Outline hole;
  for (const Vec2& p : widest) hole.push_back(0.5 * kMountHole_mm * p.normalized());
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

Object pyramid_shape(double width_mm, double height_mm, double edge_radius_mm) {
  const RoundedPyramid pyramid = rounded_pyramid(width_mm, height_mm, edge_radius_mm);
  Outline rim;
  for (const std::int32_t i : pyramid.rim)
    rim.push_back(pyramid.side.positions[std::size_t(i)].head<2>());
  return with_mount(Stack(pyramid.side, pyramid.rim), rim, pyramid.side.bounds().max.z());
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
  // The sample's own size, so that a printed shape and its simulation cannot drift apart.
  const Vec3 size = shape.scale * make_sample(shape.sample).bounds().size();
  Object object = shape.edge_radius_mm > 0 ? pyramid_shape(size.x(), size.z(), shape.edge_radius_mm)
                                           : round_shape(0.5 * size);
  stand_on_mount(object);
  return object;
}

Object dome_to_print() {
  Object dome = grooved_dome();
  stand_on_mount(dome);
  return dome;
}

}  // namespace hydrodip
