#include "job/wanted.h"

#include "base/parallel.h"
#include "image/color_difference.h"
#include "plan/targets.h"

namespace hydrodip {
namespace {

// From so far from the bare object's colour on (CIELAB) there is something to print.
constexpr double kPrinted = 2;
constexpr double kNearlyEverywhere = 0.95;

}  // namespace

std::optional<ReportWanted> wanted_coverage(const DippedObject& dipped, const Paint& paint,
                                            int points) {
  if (!paint.says_anything()) return std::nullopt;
  const TriangleMesh& mesh = dipped.posed.mesh();
  const Targets targets = spread_targets(mesh, points);
  const Vec3 bare = to_cielab(paint.base());
  struct Seen {
    bool wanted = false, reached = false, covered = false;
  };
  std::vector<Seen> seen(targets.list.size());
  parallel_for(seen.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Target& at = targets.list[i];
      seen[i].wanted = (to_cielab(paint.color_at(at.point)) - bare).norm() > kPrinted;
      if (!seen[i].wanted) continue;
      seen[i].covered = dipped.map->to_film(at.position, at.normal).has_value();
      const auto direction = dipped.direction_at(at.position, 0);
      seen[i].reached = seen[i].covered || (direction && at.normal.dot(*direction) > 0);
    }
  });
  ReportWanted wanted;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double area = targets.list[i].area;
    wanted.object_mm2 += seen[i].wanted ? area : 0;
    wanted.reached_mm2 += seen[i].reached ? area : 0;
    wanted.covered_mm2 += seen[i].covered ? area : 0;
  }
  if (!(wanted.object_mm2 > 0) || wanted.object_mm2 > kNearlyEverywhere * targets.area)
    return std::nullopt;
  return wanted;
}

}  // namespace hydrodip
