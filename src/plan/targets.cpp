#include "plan/targets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "image/color_difference.h"

namespace hydrodip {
namespace {

// Where nothing needs to be printed, film still makes the surface look and feel the same.
constexpr double kPlainShare = 0.25;
constexpr double kDetailShare = 0.25;
// All of that together at most so much of what has to be printed: beside a small picture, a large
// bare surface must not decide.
constexpr double kPlainOfPrinted = 1.0 / 3;
// What has more than that differs from the bare object.
constexpr double kHardlyPlain = kPlainShare + 0.02;
// Detail is looked for in cells of this part of the object's extent.
constexpr double kCellsAcross = 20;

void sum_up(Targets& targets) {
  targets.area = targets.weight = 0;
  for (const Target& target : targets.list) {
    targets.area += target.area;
    targets.weight += target.area * target.importance;
  }
}

void bound_plain(Targets& targets) {
  double plain = 0, printed = 0;
  for (const Target& t : targets.list)
    (t.importance < kHardlyPlain ? plain : printed) += t.area * t.importance;
  if (!(printed > 0) || plain <= kPlainOfPrinted * printed) return;
  const double share = kPlainOfPrinted * printed / plain;
  for (Target& t : targets.list)
    if (t.importance < kHardlyPlain) t.importance *= share;
}

// How far the colours of a cell lie from their mean, root of the mean square.
struct CellColors {
  double count = 0, squares = 0;
  Vec3 sum = Vec3::Zero();
  void add(const Vec3& lab) {
    count += 1;
    sum += lab;
    squares += lab.squaredNorm();
  }
  double spread() const {
    return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()));
  }
};

}  // namespace

Targets spread_targets(const TriangleMesh& mesh, int count) {
  std::vector<double> area_up_to;
  area_up_to.reserve(mesh.triangles.size());
  double total = 0;
  for (const Triangle& t : mesh.triangles)
    area_up_to.push_back(total += area_vector(mesh.positions, t).norm());
  Targets targets;
  if (!(total > 0)) return targets;
  targets.list.resize(std::size_t(count));
  parallel_for(targets.list.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto at =
          std::upper_bound(area_up_to.begin(), area_up_to.end(), total * (double(i) + 0.5) / count);
      const auto triangle = std::min(std::size_t(at - area_up_to.begin()), area_up_to.size() - 1);
      double u = std::fmod(0.5 + 0.7548776662466927 * double(i), 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * double(i), 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const SurfacePoint point{int(triangle), u, v};
      targets.list[i] = {point, position_at(mesh, point), face_normal(mesh, point.triangle),
                         total / count};
    }
  });
  sum_up(targets);
  return targets;
}

Target in_pose(const Target& target, const PosedObject& posed) {
  Target result = target;
  result.position = (posed.matrix() * target.position.homogeneous()).head<3>();
  result.normal = posed.turn() * target.normal;
  return result;
}

void weigh_by_paint(Targets& targets, const Paint& paint) {
  if (!paint.says_anything()) return;
  Box3 box;
  for (const Target& target : targets.list) box.add(target.position);
  const double cell = std::max(box.size().maxCoeff() / kCellsAcross, 1e-12);
  const auto cell_of = [&](const Target& target) {
    const Vec3 at = (target.position - box.min) / cell;
    return std::array<int, 3>{int(at.x()), int(at.y()), int(at.z())};
  };
  const Vec3 bare = to_cielab(paint.base());
  std::vector<Vec3> colors;
  std::map<std::array<int, 3>, CellColors> cells;
  for (const Target& target : targets.list) {
    check_cancelled();
    colors.push_back(to_cielab(paint.color_at(target.point)));
    cells[cell_of(target)].add(colors.back());
  }
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    const double color = std::min(1.0, (colors[i] - bare).norm() / kFullColor);
    const double detail = std::min(1.0, cells[cell_of(targets.list[i])].spread() / kFullDetail);
    targets.list[i].importance =
        kPlainShare + (1 - kPlainShare - kDetailShare) * color + kDetailShare * detail;
  }
  bound_plain(targets);
  sum_up(targets);
}

void weigh_by_picture(Targets& targets, const Paint& picture) {
  for (Target& target : targets.list) {
    const LinearColor color = picture.color_at(target.point);
    target.importance = std::clamp(
        0.2126 * double(color.r) + 0.7152 * double(color.g) + 0.0722 * double(color.b), 0.0, 1.0);
  }
  sum_up(targets);
  if (!(targets.weight > 0))
    throw InputError(
        "plan.importance: the picture is black wherever it meets the object, so nothing matters: "
        "paint white what shall be covered");
}

}  // namespace hydrodip
