#include "plan/hold.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydrodip {
namespace {

double whole_degrees(double radians) {
  const double degrees = std::round(radians / kDegree);
  return degrees == -180 ? 180 : degrees + 0.0;  // -0 becomes 0
}

Mat3 rotation_of(const PoseOptions& pose) {
  PoseOptions turned = pose;
  turned.size_mm = 0;
  return pose_matrix({}, turned).topLeftCorner<3, 3>();
}

// The model's direction that points down.
Vec3 model_down(const PoseOptions& pose) { return -rotation_of(pose).row(2).transpose(); }

Vec3 direction_of(ModelSide side) {
  const int axis = int(side) / 2;
  return (int(side) % 2 == 0 ? -1.0 : 1.0) * Vec3::Unit(axis);
}

// The side that a direction is nearest to; of equals the first.
ModelSide nearest_side(const Vec3& direction, double& angle_deg) {
  ModelSide best = ModelSide::kMinusX;
  double most = -2;
  for (const ModelSide side : {ModelSide::kMinusX, ModelSide::kPlusX, ModelSide::kMinusY,
                               ModelSide::kPlusY, ModelSide::kMinusZ, ModelSide::kPlusZ}) {
    const double cosine = direction.dot(direction_of(side));
    if (cosine <= most + 1e-9) continue;
    most = cosine;
    best = side;
  }
  angle_deg = std::acos(std::clamp(most, -1.0, 1.0)) / kDegree;
  return best;
}

}  // namespace

PoseOptions hold(const PoseOptions& base, const Vec3& down, double turn_deg) {
  const Vec3 d = down.normalized();
  const double across = std::hypot(d.y(), d.z());
  PoseOptions pose = base;
  const double about_x = across > 1e-9 ? std::atan2(-d.y(), -d.z()) : 0;
  pose.rotate_deg = {whole_degrees(about_x), whole_degrees(std::atan2(d.x(), across)),
                     whole_degrees(turn_deg * kDegree)};
  return pose;
}

Vec3 down_of(const PoseOptions& pose) {
  PoseOptions turned = pose;
  turned.down = ModelSide::kMinusZ;
  return model_down(turned);
}

double roomiest_turn_deg(const std::vector<Vec3>& positions, const PoseOptions& pose,
                         const FilmOptions& film) {
  PoseOptions unturned = pose;
  unturned.rotate_deg.z() = 0;
  const Mat3 rotation = rotation_of(unturned);
  std::vector<Vec2> seen;
  seen.reserve(positions.size());
  for (const Vec3& p : positions) seen.push_back((rotation * p).head<2>());
  constexpr int kStep_deg = 5;
  double best = 0, least = 1e300;
  for (int turn = 0; turn < 180; turn += kStep_deg) {
    const double c = std::cos(turn * kDegree), s = std::sin(turn * kDegree);
    Box2 box;
    for (const Vec2& p : seen) box.add({c * p.x() - s * p.y(), s * p.x() + c * p.y()});
    if (box.empty()) return 0;
    const Vec2 size = box.max - box.min;
    const double part = std::max(size.x() / film.width_mm, size.y() / film.height_mm);
    if (part < least * (1 - 1e-6)) {
      least = part;
      best = turn;
    }
  }
  return best;
}

std::vector<Vec3> spread_directions(int count) {
  std::vector<Vec3> list;
  const auto add = [&](int zeros) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if ((x == 0) + (y == 0) + (z == 0) == zeros) list.push_back(Vec3(x, y, z).normalized());
  };
  for (const int zeros : {2, 0, 1}) add(zeros);
  // Those of a golden spiral that are far from all of these.
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const int more = std::max(0, count - int(list.size()));
  const double near_deg = 0.45 * std::sqrt(4 * std::numbers::pi / std::max(1, count)) / kDegree;
  for (int i = 0; i < 2 * more; ++i) {
    const double z = 1 - (2 * i + 1) / double(2 * more);
    const double r = std::sqrt(1 - z * z);
    const Vec3 d(r * std::cos(golden * i), r * std::sin(golden * i), z);
    const bool is_new = std::none_of(list.begin(), list.end(), [&](const Vec3& other) {
      return d.dot(other) > std::cos(near_deg * kDegree);
    });
    if (is_new) list.push_back(d);
  }
  if (int(list.size()) > count) list.resize(std::size_t(count));
  return list;
}

std::vector<Vec3> directions_around(const Vec3& down, double angle_deg, int count) {
  const Vec3 d = down.normalized();
  const Vec3 side = d.unitOrthogonal(), other = d.cross(side);
  std::vector<Vec3> list;
  for (int k = 0; k < count; ++k) {
    const double around = 2 * std::numbers::pi * k / count;
    list.push_back(std::cos(angle_deg * kDegree) * d +
                   std::sin(angle_deg * kDegree) *
                       (std::cos(around) * side + std::sin(around) * other));
  }
  return list;
}

std::string describe_hold(const PoseOptions& pose, ModelSide up) {
  const Vec3 down = model_down(pose);
  double tilt_deg = 0;
  const ModelSide side = nearest_side(down, tilt_deg);
  const double upright = direction_of(side).dot(direction_of(up));
  std::string text = upright < -0.5  ? "standing upright"
                     : upright > 0.5 ? "upside down"
                                     : fmt::format("lying on its {} side", side_name(side));
  if (tilt_deg < 1.5) return text;
  double ignored = 0;
  const Vec3 rest = down - down.dot(direction_of(side)) * direction_of(side);
  return text + fmt::format(", tilted by {:.0f} degrees towards its {} side", tilt_deg,
                            side_name(nearest_side(rest.normalized(), ignored)));
}

std::string hold_options(const PoseOptions& pose) {
  std::string text = pose.down == ModelSide::kMinusZ
                         ? std::string()
                         : fmt::format("--down {} ", side_name(pose.down));
  return text + fmt::format("--rotate {:g},{:g},{:g}", pose.rotate_deg.x(), pose.rotate_deg.y(),
                            pose.rotate_deg.z());
}

}  // namespace hydrodip
