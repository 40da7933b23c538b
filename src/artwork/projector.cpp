#include "artwork/projector.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"

namespace hydrodip {
namespace {

// A position may be typed from a ruler or another program: so far off in shares of the model's
// size, and never less than so many mm.
constexpr double kNearShare = 0.05, kNear_mm = 2;
// Of two directions that are nearly one.
constexpr double kParallel = 0.9;

// ---- planar ----

class PlanarProjector : public Projector {
 public:
  PlanarProjector(const Vec3& at, const Vec3& toward, const Upright& axes)
      : at_(at), back_(-toward), right_(axes.right), up_(axes.up) {}
  Vec2 flat(const Vec3& point, const Vec3&) const override {
    const Vec3 d = point - at_;
    return {d.dot(right_), d.dot(up_)};
  }
  Vec3 back(const Vec3&, const Vec3&) const override { return back_; }

 private:
  Vec3 at_, back_, right_, up_;
};

// ---- cylinder and sphere ----

// Directions around an axis: `front` is where the picture's centre lies, `side` to its right.
struct RoundFrame {
  Vec3 centre, axis, front, side;
};

RoundFrame round_frame(const Vec3& centre, const Vec3& axis, const Vec3& towards_viewer) {
  const Vec3 front = (towards_viewer - towards_viewer.dot(axis) * axis).normalized();
  return {centre, axis, front, axis.cross(front)};
}

class CylinderProjector : public Projector {
 public:
  CylinderProjector(const RoundFrame& frame, double radius_mm, double height_mm)
      : frame_(frame), radius_(radius_mm), height_(height_mm) {}
  Vec2 flat(const Vec3& point, const Vec3&) const override {
    const Vec3 d = point - frame_.centre;
    return {radius_ * std::atan2(d.dot(frame_.side), d.dot(frame_.front)),
            d.dot(frame_.axis) - height_};
  }
  Vec3 back(const Vec3& point, const Vec3&) const override {
    const Vec3 d = point - frame_.centre;
    const Vec3 out = d - d.dot(frame_.axis) * frame_.axis;
    const double length = out.norm();
    return length > 0 ? Vec3(out / length) : frame_.front;
  }
  double curved_mm() const override { return 0.2 * radius_; }

 private:
  RoundFrame frame_;
  double radius_, height_;
};

class SphereProjector : public Projector {
 public:
  SphereProjector(const RoundFrame& frame, double radius_mm, double latitude)
      : frame_(frame),
        radius_(radius_mm),
        latitude_(latitude),
        along_(radius_mm * std::cos(latitude)) {}
  Vec2 flat(const Vec3& point, const Vec3&) const override {
    const Vec3 d = point - frame_.centre;
    const double x = d.dot(frame_.front), y = d.dot(frame_.side);
    return {along_ * std::atan2(y, x),
            radius_ * (std::atan2(d.dot(frame_.axis), std::hypot(x, y)) - latitude_)};
  }
  Vec3 back(const Vec3& point, const Vec3&) const override {
    const Vec3 d = point - frame_.centre;
    const double length = d.norm();
    return length > 0 ? Vec3(d / length) : frame_.front;
  }
  double curved_mm() const override { return 0.1 * radius_; }

 private:
  RoundFrame frame_;
  double radius_, latitude_, along_;
};

// Where the surface's normals come from: the point next to all the lines along them, square to an
// axis if one is given. Handles and feet are outvoted: three rounds with less weight for what is
// far off. Starts from the bounds' centre, which is also the answer where normals do not tell.
Vec3 centre_of_normals(const TriangleMesh& mesh, const Vec3* axis) {
  const Box3 box = mesh.bounds();
  const double size = std::max(box.size().norm(), 1e-9);
  Vec3 centre = box.center();
  const Mat3 across = axis ? Mat3(Mat3::Identity() - *axis * axis->transpose()) : Mat3::Identity();
  constexpr int kRounds = 20;
  for (int round = 0; round < kRounds; ++round) {
    Mat3 sum = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    double total = 0;
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.positions[std::size_t(t[0])];
      const Vec3& b = mesh.positions[std::size_t(t[1])];
      const Vec3& c = mesh.positions[std::size_t(t[2])];
      Vec3 normal = (b - a).cross(c - a);
      const double area = normal.norm();
      normal = across * normal;
      const double length = normal.norm();
      if (!(length > 0.2 * area)) continue;  // caps say nothing about an axis
      normal /= length;
      const Mat3 line = across - normal * normal.transpose();
      const Vec3 off = line * ((a + b + c) / 3 - centre);
      const double weight = length / (off.norm() + 1e-3 * size);
      sum += weight * line;
      right += weight * off;
      total += weight;
    }
    if (!(total > 0)) return centre;
    // Directions in which nothing is known stay.
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(sum / total);
    Vec3 step = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const double strength = solver.eigenvalues()[k];
      if (strength > 1e-3)
        step += solver.eigenvectors().col(k).dot(right / total) / strength *
                solver.eigenvectors().col(k);
    }
    centre += step;
    if (step.norm() < 1e-7 * size) break;
  }
  return centre;
}

// ---- box ----

class BoxProjector : public Projector {
 public:
  BoxProjector(const Vec3& at, const Vec3& toward, const Upright& axes)
      : at_(at), toward_(toward), right_(axes.right), up_(axes.up) {}
  Vec2 flat(const Vec3& point, const Vec3& normal) const override {
    const Vec3 d = point - at_;
    const Vec3 back = back_of(normal);
    const double over = back.dot(up_);
    if (std::abs(over) > 0.5) return {d.dot(right_), over * d.dot(toward_)};
    return {d.dot(up_.cross(back)), d.dot(up_)};
  }
  Vec3 back(const Vec3&, const Vec3& normal) const override { return back_of(normal); }
  bool has_sides() const override { return true; }

 private:
  Vec3 back_of(const Vec3& normal) const {
    const double t = normal.dot(toward_), r = normal.dot(right_), u = normal.dot(up_);
    // Of equal ones always the same.
    constexpr double kMore = 1 + 1e-9;
    if (std::abs(t) * kMore >= std::abs(r) && std::abs(t) * kMore >= std::abs(u))
      return t > 0 ? toward_ : Vec3(-toward_);
    if (std::abs(r) * kMore >= std::abs(u)) return r > 0 ? right_ : Vec3(-right_);
    return u > 0 ? up_ : Vec3(-up_);
  }
  Vec3 at_, toward_, right_, up_;
};

// ---- what is chosen ----

Vec3 unit(const Vec3& direction, const char* what, const PlacementTask& task) {
  const double length = direction.norm();
  if (!(length > 1e-9) || !std::isfinite(length))
    throw InputError(fmt::format("{}: the artwork's direction {} ({}) has no length",
                                 name_of(task.layer), what, as_given(direction)));
  return direction / length;
}

// The model's z, or y where that is the way somebody looks.
Vec3 usual_up(const ModelFrame& frame, const Vec3& toward) {
  const Vec3 z = frame.turn.col(2);
  return std::abs(z.dot(toward)) < kParallel ? z : Vec3(frame.turn.col(1));
}

struct Extent {
  double least = 1e300, most = -1e300;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double middle() const { return 0.5 * (least + most); }
  // To the nearer end.
  double room(double value) const { return std::min(value - least, most - value); }
};

Extent extent(const TriangleMesh& mesh, const Vec3& direction) {
  Extent extent;
  for (const Vec3& p : mesh.positions) extent.add(p.dot(direction));
  return extent;
}

[[noreturn]] void refuse_beside(const PlacementTask& task) {
  const ModelFrame frame(task.posed);
  Box3 box;
  for (const Vec3& p : task.posed.mesh().positions) box.add(frame.back(p));
  throw InputError(fmt::format(
      "{}: the artwork at {} lies beside the model, which reaches from {} to {} (mm, "
      "in the model's "
      "frame after --size); move it with --art-at",
      name_of(task.layer), as_given(*task.layer.at_mm), as_given(box.min), as_given(box.max)));
}

// The way a planar picture goes: as told; else square to the surface where it is told to lie; else
// from the side that enters the water first.
Vec3 way_of(const PlacementTask& task, const ModelFrame& frame) {
  if (task.layer.toward) return unit(frame.turn * *task.layer.toward, "toward", task);
  if (!task.layer.at_mm) return Vec3::UnitZ();
  const SurfaceHit hit = nearest_to(task, frame.point(*task.layer.at_mm));
  return -seen_from(task, hit);
}

Aimed aim_plane(const PlacementTask& task) {
  const ModelFrame frame(task.posed);
  const TriangleMesh& mesh = task.posed.mesh();
  const Vec3 toward = way_of(task, frame);
  const Upright axes = upright(task, toward);
  const Extent right = extent(mesh, axes.right), up = extent(mesh, axes.up);
  Vec3 at = right.middle() * axes.right + up.middle() * axes.up;
  if (task.layer.at_mm) at = frame.point(*task.layer.at_mm);
  const Vec2 room(right.room(at.dot(axes.right)), up.room(at.dot(axes.up)));
  const Vec2 size = fitting_size(task, room);
  ArtworkLayer layer = task.layer;
  if (!layer.toward && !layer.at_mm) layer.toward = rounded(frame.direction_back(toward));
  return {std::make_unique<PlanarProjector>(at, toward, axes), size, std::move(layer)};
}

// The way somebody looks who stands before the model: along its y, or where that is up, against its
// z. All six sides are laid on, so that it does not matter which one enters the water first.
Vec3 front_of(const PlacementTask& task, const ModelFrame& frame) {
  if (task.layer.toward) return unit(frame.turn * *task.layer.toward, "toward", task);
  const bool y_is_up = task.layer.up && std::abs(unit(*task.layer.up, "up", task).y()) >= kParallel;
  return y_is_up ? Vec3(-frame.turn.col(2)) : Vec3(frame.turn.col(1));
}

Aimed aim_box(const PlacementTask& task) {
  const ModelFrame frame(task.posed);
  const TriangleMesh& mesh = task.posed.mesh();
  const Vec3 toward = front_of(task, frame);
  const Upright axes = upright(task, toward);
  const Extent right = extent(mesh, axes.right), up = extent(mesh, axes.up),
               deep = extent(mesh, toward);
  Vec3 at = right.middle() * axes.right + up.middle() * axes.up + deep.middle() * toward;
  if (task.layer.at_mm) at = frame.point(*task.layer.at_mm);
  const double room_right = right.room(at.dot(axes.right)), room_up = up.room(at.dot(axes.up)),
               room_deep = deep.room(at.dot(toward));
  const Vec2 front = fitting_size(task, {room_right, room_up}),
             side = fitting_size(task, {room_deep, room_up}),
             top = fitting_size(task, {room_right, room_deep});
  return {std::make_unique<BoxProjector>(at, toward, axes), front.cwiseMin(side).cwiseMin(top),
          task.layer};
}

// Of the model's x, y and z the one to which its surface is most nearly parallel; upright rather
// than lying where that is undecided.
Vec3 likely_axis(const TriangleMesh& mesh, const ModelFrame& frame) {
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.positions[std::size_t(t[0])];
    const Vec3 normal =
        frame.turn.transpose() *
        (mesh.positions[std::size_t(t[1])] - a).cross(mesh.positions[std::size_t(t[2])] - a);
    const double length = normal.norm();
    if (length > 0) sum += normal.cwiseAbs2() / length;
  }
  constexpr double kClearly = 0.9;
  int best = 2;
  for (const int k : {1, 0})
    if (sum[k] < kClearly * sum[best]) best = k;
  return frame.turn.col(best);
}

// From the axis or centre to where the picture's centre lies: as told, else the side that enters
// the water first, else the model's front (-y), square enough to the axis.
Vec3 viewer_of(const PlacementTask& task, const ModelFrame& frame, const Vec3& centre,
               const Vec3& axis) {
  if (task.layer.at_mm) {
    Vec3 told = frame.point(*task.layer.at_mm) - centre;
    if ((told - told.dot(axis) * axis).norm() > 1e-6) return told;
  }
  for (const Vec3& side : {Vec3(-Vec3::UnitZ()), Vec3(-frame.turn.col(1)), Vec3(frame.turn.col(0))})
    if (std::abs(side.dot(axis)) < kParallel) return side;
  return frame.turn.col(2);
}

// From outside towards the axis or centre: how far from it the surface is. The mean where a ray
// finds none.
double radius_at(const PlacementTask& task, const Vec3& foot, const Vec3& out) {
  const double far_mm = task.posed.mesh().bounds().size().norm() + 1;
  if (const auto hit = task.posed.surface().first_hit(foot + far_mm * out, -out, 0, far_mm))
    return std::max(far_mm - hit->t, 1e-6);
  double sum = 0;
  for (const Vec3& p : task.posed.mesh().positions) sum += (p - foot).norm();
  return std::max(sum / double(task.posed.mesh().positions.size()), 1e-6);
}

// The layer, with its centre where a ray from the axis or centre to the viewer leaves the surface.
ArtworkLayer seen_there(const PlacementTask& task, const ModelFrame& frame, const Vec3& point) {
  ArtworkLayer layer = task.layer;
  if (layer.at_mm) return layer;
  const auto hit = task.posed.surface().closest_point(point, 1e9);
  layer.at_mm = rounded(frame.back(hit ? task.posed.surface().position(*hit) : point));
  return layer;
}

Vec3 axis_of(const PlacementTask& task, const ModelFrame& frame, const Vec3& usual) {
  Vec3 axis = task.layer.toward ? unit(frame.turn * *task.layer.toward, "toward", task) : usual;
  if (task.layer.up) return axis.dot(frame.turn * *task.layer.up) < 0 ? Vec3(-axis) : axis;
  // An axis has no direction of its own: up is the model's z, else its y, else its x.
  constexpr double kSome = 1e-3;
  for (const int k : {2, 1, 0}) {
    const double along = axis.dot(frame.turn.col(k));
    if (std::abs(along) > kSome) return along < 0 ? Vec3(-axis) : axis;
  }
  return axis;
}

Aimed aim_cylinder(const PlacementTask& task) {
  const ModelFrame frame(task.posed);
  const TriangleMesh& mesh = task.posed.mesh();
  const Vec3 axis = axis_of(task, frame, likely_axis(mesh, frame));
  const Vec3 centre = centre_of_normals(mesh, &axis);
  const RoundFrame round = round_frame(centre, axis, viewer_of(task, frame, centre, axis));
  const Extent along = extent(mesh, axis);
  const double height =
      task.layer.at_mm ? frame.point(*task.layer.at_mm).dot(axis) : along.middle();
  if (task.layer.at_mm) nearest_to(task, frame.point(*task.layer.at_mm));
  const double from_centre = height - centre.dot(axis);
  const double radius = radius_at(task, centre + from_centre * axis, round.front);
  const Vec2 size = fitting_size(task, {0.5 * std::numbers::pi * radius, along.room(height)});
  return {std::make_unique<CylinderProjector>(round, radius, from_centre), size,
          seen_there(task, frame, centre + from_centre * axis + radius * round.front)};
}

Aimed aim_sphere(const PlacementTask& task) {
  const ModelFrame frame(task.posed);
  const Vec3 centre = centre_of_normals(task.posed.mesh(), nullptr);
  Vec3 out = -Vec3::UnitZ();
  if (task.layer.at_mm) {
    const SurfaceHit hit = nearest_to(task, frame.point(*task.layer.at_mm));
    out = (task.posed.surface().position(hit) - centre).normalized();
  }
  const Vec3 axis = axis_of(task, frame, usual_up(frame, -out));
  if (!task.layer.at_mm) out = viewer_of(task, frame, centre, axis);
  const RoundFrame round = round_frame(centre, axis, out);
  constexpr double kSteepest = 85 * std::numbers::pi / 180;
  const double latitude =
      task.layer.at_mm ? std::clamp(std::asin(std::clamp(out.normalized().dot(axis), -1.0, 1.0)),
                                    -kSteepest, kSteepest)
                       : 0;
  const double radius = radius_at(
      task, centre, (std::cos(latitude) * round.front + std::sin(latitude) * axis).normalized());
  const Vec2 size = fitting_size(task, {0.5 * std::numbers::pi * radius * std::cos(latitude),
                                        radius * (0.5 * std::numbers::pi - std::abs(latitude))});
  return {std::make_unique<SphereProjector>(round, radius, latitude), size,
          seen_there(task, frame, centre + radius * round.front)};
}

}  // namespace

std::string as_given(const Vec3& p) {
  return fmt::format("{:.1f},{:.1f},{:.1f}", p.x(), p.y(), p.z());
}

Vec3 rounded(const Vec3& v) {
  constexpr double kPerUnit = 1e6;
  // Zero without a sign.
  return Vec3((kPerUnit * v).array().round() / kPerUnit) + Vec3::Zero();
}

ModelFrame::ModelFrame(const PosedObject& posed)
    : turn(posed.turn()), offset(posed.matrix().topRightCorner<3, 1>()) {}

SurfaceHit nearest_to(const PlacementTask& task, const Vec3& at) {
  const ModelFrame frame(task.posed);
  const double size = task.posed.mesh().bounds().size().norm();
  const double away = (at - task.posed.mesh().bounds().center()).norm();
  const auto hit = task.posed.surface().closest_point(at, away + size);
  if (!hit) refuse_beside(task);
  if (hit->t > std::max(kNear_mm, kNearShare * size))
    throw InputError(fmt::format(
        "{}: the artwork at {} is {:.1f} mm away from the model, whose surface is nearest at {} "
        "(mm, in the model's frame after --size); move it there with --art-at",
        name_of(task.layer), as_given(*task.layer.at_mm), hit->t,
        as_given(frame.back(task.posed.surface().position(*hit)))));
  return *hit;
}

Vec3 seen_from(const PlacementTask& task, const SurfaceHit& hit) {
  const Surface& surface = task.posed.surface();
  Vec3 normal = surface.normal(hit);
  if (task.closed) return normal;
  const Vec3 point = surface.position(hit);
  constexpr double kStart_mm = 1e-2, kSlant = 1.2;  // 67 degrees
  constexpr int kAround = 8;
  const double far_mm = 2 * task.posed.mesh().bounds().size().norm();
  const Vec3 across = normal.unitOrthogonal(), along = normal.cross(across);
  // From how many directions the point can be seen.
  const auto open_ways = [&](const Vec3& way) {
    int free = surface.is_hit(point, way, kStart_mm, far_mm) ? 0 : 1;
    for (int k = 0; k < kAround; ++k) {
      const double turn = 2 * std::numbers::pi * k / kAround;
      const Vec3 slanted = std::cos(kSlant) * way +
                           std::sin(kSlant) * (std::cos(turn) * across + std::sin(turn) * along);
      if (!surface.is_hit(point, slanted, kStart_mm, far_mm)) ++free;
    }
    return free;
  };
  return open_ways(-normal) > open_ways(normal) ? Vec3(-normal) : normal;
}

Upright upright(const PlacementTask& task, const Vec3& toward) {
  const ModelFrame frame(task.posed);
  const Vec3 up =
      task.layer.up ? unit(frame.turn * *task.layer.up, "up", task) : usual_up(frame, toward);
  const Vec3 right = toward.cross(up);
  if (!(right.norm() > 1e-3))
    throw InputError(
        fmt::format("{}: the artwork's up ({}) is the way it is projected; give another --art-up",
                    name_of(task.layer), as_given(task.layer.up.value_or(Vec3::Zero()))));
  return {right.normalized(), right.normalized().cross(toward)};
}

Vec2 fitting_size(const PlacementTask& task, const Vec2& room_mm) {
  const ArtworkLayer& layer = task.layer;
  if (layer.width_mm > 0 && layer.height_mm > 0) return {layer.width_mm, layer.height_mm};
  if (layer.width_mm > 0) return {layer.width_mm, layer.width_mm / task.aspect};
  if (layer.height_mm > 0) return {layer.height_mm * task.aspect, layer.height_mm};
  if (!(room_mm.minCoeff() > 0)) {
    if (layer.at_mm) refuse_beside(task);
    throw InputError(fmt::format(
        "{}: from there the model has no width that artwork could lie on; give --art-toward",
        name_of(layer)));
  }
  const double turn = layer.turn_deg * std::numbers::pi / 180;
  const double sine = std::abs(std::sin(turn)), cosine = std::abs(std::cos(turn));
  const double tall = 1 / task.aspect;
  const double width =
      2 * std::min(room_mm.x() / (cosine + tall * sine), room_mm.y() / (sine + tall * cosine));
  return {width, width * tall};
}

Aimed aim(const PlacementTask& task) {
  switch (task.layer.projection) {
    case Projection::kCylinder:
      return aim_cylinder(task);
    case Projection::kSphere:
      return aim_sphere(task);
    case Projection::kBox:
      return aim_box(task);
    default:
      return aim_plane(task);
  }
}

}  // namespace hydrodip
