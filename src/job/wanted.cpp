#include "job/wanted.h"

#include <fmt/format.h>

#include "base/parallel.h"
#include "image/color_difference.h"

namespace hydrodip {
namespace {

// From so far from the bare object's colour on (CIELAB) there is something to print.
constexpr double kPrinted = 2;
constexpr double kNearlyEverywhere = 0.95;
// Of a layer of artwork: with less film it is as good as lost.
constexpr double kHardlyAny = 0.05;

}  // namespace

std::vector<std::uint8_t> wanted_at(const Targets& targets, const Paint& paint) {
  if (!paint.says_anything()) return {};
  const Vec3 bare = to_cielab(paint.base());
  std::vector<std::uint8_t> wanted(targets.list.size());
  parallel_for(wanted.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      wanted[i] = (to_cielab(paint.color_at(targets.list[i].point)) - bare).norm() > kPrinted;
  });
  double wanted_mm2 = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted_mm2 += wanted[i] * targets.list[i].area;
  if (!(wanted_mm2 > 0) || wanted_mm2 > kNearlyEverywhere * targets.area) return {};
  return wanted;
}

bool faces_film(const DippedObject& dipped, const Target& at) {
  const auto direction = dipped.direction_at(at.position, 0);
  return direction && at.normal.dot(*direction) > 0;
}

bool is_reached(const DippedObject& dipped, const Target& node) {
  const Target hung = in_pose(node, dipped.posed);
  return dipped.map->to_film(hung.position, hung.normal) || faces_film(dipped, hung);
}

bool is_in_doubt(const std::optional<FilmMap::Hold>& hold, const DoubtfulStretch& doubtful) {
  return hold && !hold->let_go && hold->stretch < doubtful.to &&
         (hold->stretch > doubtful.from || hold->moved_mm > kMoved_mm);
}

std::optional<ReportWanted> wanted_coverage(const DippedObject& dipped, const Paint& paint,
                                            const DoubtfulStretch& doubtful, int points) {
  if (!paint.says_anything() || paint.depends_on_film()) return std::nullopt;
  const Targets targets = spread_targets(dipped.posed.mesh(), points);
  const std::vector<std::uint8_t> is_wanted = wanted_at(targets, paint);
  if (is_wanted.empty()) return std::nullopt;
  struct Seen {
    bool reached = false, covered = false, in_doubt = false;
  };
  std::vector<Seen> seen(targets.list.size());
  parallel_for(seen.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_wanted[i]) continue;
      const Target& at = targets.list[i];
      const FilmMap::Lying lying = dipped.map->lying_at(at.position, at.normal);
      seen[i].covered = lying.film.has_value();
      seen[i].in_doubt = seen[i].covered && is_in_doubt(lying.hold, doubtful);
      seen[i].reached = seen[i].covered || faces_film(dipped, at);
    }
  });
  ReportWanted wanted;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (is_wanted[i])
      wanted.add(targets.list[i].area, seen[i].reached, seen[i].covered, seen[i].in_doubt);
  return wanted;
}

std::vector<DryLayer> dry_layers(const std::vector<LaidLayer>& layers, const Targets& targets,
                                 const std::function<bool(const Target&)>& gets_film) {
  std::vector<DryLayer> dry;
  std::vector<std::uint8_t> shows(targets.list.size());
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const LaidLayer& layer = layers[n];
    if (!layer.shows) continue;
    parallel_for(shows.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) shows[i] = layer.shows(targets.list[i].point);
    });
    double shown_mm2 = 0, covered_mm2 = 0;
    for (std::size_t i = 0; i < shows.size(); ++i) {
      if (!shows[i]) continue;
      shown_mm2 += targets.list[i].area;
      if (gets_film(targets.list[i])) covered_mm2 += targets.list[i].area;
    }
    // So small that it lies between the points: unknown.
    if (!(shown_mm2 > 0) || covered_mm2 > kHardlyAny * shown_mm2) continue;
    dry.push_back(
        {n, fmt::format(
                "{}: this artwork gets {} film that holds; turn it down (--down, --rotate), dip "
                "deeper (--depth), move it (--art-at), or give it a dip of its own (--dips).",
                layer.name, covered_mm2 > 0 ? "hardly any" : "no")});
  }
  return dry;
}

std::vector<DryLayer> dry_layers(const std::vector<LaidLayer>& layers, const DippedObject& dipped,
                                 int points) {
  if (layers.empty()) return {};
  return dry_layers(layers, spread_targets(dipped.posed.mesh(), points), [&](const Target& at) {
    return bool(dipped.map->to_film(at.position, at.normal));
  });
}

void warn_of(const std::vector<DryLayer>& layers, const RunContext& context) {
  for (const DryLayer& layer : layers) context.warn(layer.told);
}

}  // namespace hydrodip
