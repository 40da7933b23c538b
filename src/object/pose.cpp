#include "object/pose.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace hydrodip {

namespace {

// Quarter turns are exact, so that an upright box stays an upright box.
void sine_cosine(double degrees, double& sine, double& cosine) {
  const double turn = std::fmod(degrees, 360.0);
  if (std::fmod(turn, 90.0) == 0) {
    const int quarter = (int(turn / 90) + 4) % 4;
    sine = quarter == 1 ? 1 : quarter == 3 ? -1 : 0;
    cosine = quarter == 0 ? 1 : quarter == 2 ? -1 : 0;
    return;
  }
  sine = std::sin(turn * std::numbers::pi / 180);
  cosine = std::cos(turn * std::numbers::pi / 180);
}

// Turns about coordinate axis 0, 1 or 2, counter-clockwise seen from its tip.
Mat3 axis_rotation(int axis, double degrees) {
  double sine = 0, cosine = 1;
  sine_cosine(degrees, sine, cosine);
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  Mat3 rotation = Mat3::Identity();
  rotation(j, j) = rotation(k, k) = cosine;
  rotation(k, j) = sine;
  rotation(j, k) = -sine;
  return rotation;
}

Mat3 down_rotation(ModelSide down) {
  switch (down) {
    case ModelSide::kPlusZ:
      return axis_rotation(0, 180);
    case ModelSide::kMinusX:
      return axis_rotation(1, -90);
    case ModelSide::kPlusX:
      return axis_rotation(1, 90);
    case ModelSide::kMinusY:
      return axis_rotation(0, 90);
    case ModelSide::kPlusY:
      return axis_rotation(0, -90);
    case ModelSide::kMinusZ:
      break;
  }
  return Mat3::Identity();
}

double size_scale(const TriangleMesh& mesh, double size_mm) {
  if (size_mm == 0) return 1;
  if (!std::isfinite(size_mm) || size_mm < 0) {
    throw InputError(fmt::format("--size {}: must be a positive length in mm.", size_mm));
  }
  const double extent = mesh.bounds().size().maxCoeff();
  if (!(extent > 0)) throw InputError("--size: the model has no extent that could be scaled.");
  return size_mm / extent;
}

}  // namespace

const char* side_name(ModelSide side) {
  constexpr std::array<const char*, 6> kNames = {"-x", "+x", "-y", "+y", "-z", "+z"};
  return kNames[std::size_t(side)];
}

Eigen::Matrix4d pose_matrix(const TriangleMesh& mesh, const PoseOptions& options) {
  if (!options.rotate_deg.allFinite()) throw InputError("--rotate: the angles must be numbers.");
  const Mat3 turn = axis_rotation(2, options.rotate_deg.z()) *
                    axis_rotation(1, options.rotate_deg.y()) *
                    axis_rotation(0, options.rotate_deg.x()) * down_rotation(options.down);
  const Mat3 linear = size_scale(mesh, options.size_mm) * turn;
  Box3 box;
  for (const Vec3& p : mesh.positions) box.add(linear * p);
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() = linear;
  if (!box.empty()) {
    const Vec3 center = box.center();
    pose.topRightCorner<3, 1>() = Vec3(-center.x(), -center.y(), -box.min.z());
  }
  return pose;
}

void apply_pose(TriangleMesh& mesh, const Eigen::Matrix4d& pose) {
  const Mat3 linear = pose.topLeftCorner<3, 3>();
  const Vec3 offset = pose.topRightCorner<3, 1>();
  for (Vec3& p : mesh.positions) p = linear * p + offset;
}

}  // namespace hydrodip
