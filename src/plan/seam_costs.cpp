#include "plan/seam_costs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "base/run_scope.h"
#include "image/color_difference.h"
#include "plan/nearest_node.h"

namespace hydrodip {
namespace {

// Costs are whole thousandths of what a millimetre of plainly visible seam costs.
constexpr double kUnit = 1000;
// A square millimetre of film that is worth nothing costs as much as so many millimetres of seam;
// one that is bare although another dip could cover it, so many.
constexpr double kPoorFilm = 4;
constexpr double kLeftBare = 100;
// Film's borders move a little with its ink, and a fade needs room: they are avoided that far.
constexpr double kBorder_mm = 2.5;
constexpr double kPoorBorder = 3;
// Ink fades in over that much at the border of its film.
constexpr double kFadeIn_mm = 0.6;

// What a seam is seen by.
constexpr double kAlwaysSeen = 0.15;
constexpr double kInkSeen = 0.55;
constexpr double kDetailSeen = 0.3;
constexpr double kHollowSeen = 0.4;  // at least that, in the deepest hollow
constexpr int kRays = 32;

// Of evenly spread nodes that are neighbours up to 1.7 spacings apart, a straight line cuts so many
// pairs in every spacing of its length: 2/3 of 1.7 cubed.
constexpr double kPairsAcross = 3.275;

std::vector<Vec3> hemisphere() {
  std::vector<Vec3> rays;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kRays; ++i) {
    const double z = std::sqrt((i + 0.5) / kRays);  // even in cosine
    const double r = std::sqrt(1 - z * z);
    rays.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return rays;
}

// Share of the half space above a point from which it is seen.
double exposure(const Surface& surface, const Target& node, double step, double extent) {
  static const std::vector<Vec3> rays = hemisphere();
  const Vec3 side = node.normal.unitOrthogonal(), other = node.normal.cross(side);
  const Vec3 origin = node.position + 0.5 * step * node.normal;
  int open = 0;
  for (const Vec3& ray : rays) {
    const Vec3 direction = ray.x() * side + ray.y() * other + ray.z() * node.normal;
    open += surface.is_hit(origin, direction, 0, extent) ? 0 : 1;
  }
  return double(open) / kRays;
}

// Nodes where a dip's film is worth nothing.
NearestNode bare_nodes(const SurfaceNodes& nodes, const std::vector<float>& worth) {
  std::vector<std::int32_t> bare;
  for (std::size_t i = 0; i < worth.size(); ++i)
    if (!(worth[i] > 0)) bare.push_back(std::int32_t(i));
  return {nodes, bare};
}

using NodePairs = std::vector<std::array<std::int32_t, 2>>;

// Per node, and of films per dip and node.
struct NodeMeasures {
  std::vector<Vec3> color;                   // CIELAB
  std::vector<double> exposed;               // share of the half space above
  std::vector<std::vector<float>> depth_in;  // from the film's border: 0 to 1 at kBorder_mm
  std::vector<std::vector<float>> inside;    // as SeamCosts::inside
};

double far_enough(const SurfaceNodes& nodes) {
  Box3 box;
  for (const Target& node : nodes.nodes()) box.add(node.position);
  return box.empty() ? 1.0 : 2 * box.size().norm();
}

NodeMeasures measure_nodes(const SeamTask& task) {
  const SurfaceNodes& nodes = *task.nodes;
  const std::size_t count = nodes.nodes().size(), dips = task.worth.size();
  const double border = kBorder_mm / task.scale, fade_in = kFadeIn_mm / task.scale;
  const double extent = far_enough(nodes);
  const std::vector<std::vector<float>> none(dips, std::vector<float>(count, 0));
  NodeMeasures all{std::vector<Vec3>(count), std::vector<double>(count), none, none};
  std::vector<NearestNode> bare;
  for (const std::vector<float>& worth : task.worth) bare.push_back(bare_nodes(nodes, worth));
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      check_cancelled();
      const Target& node = nodes.nodes()[i];
      all.color[i] = to_cielab(task.paint.color_at(node.point));
      all.exposed[i] = exposure(task.surface, node, nodes.spacing(), extent);
      for (std::size_t k = 0; k < dips; ++k) {
        if (!(task.worth[k][i] > 0)) continue;
        const auto out = bare[k].find(node.position, node.normal, border);
        const double to_border = out.node >= 0 ? std::sqrt(out.squared) : border;
        all.depth_in[k][i] = float(to_border / border);
        all.inside[k][i] = float(std::clamp(to_border / fade_in, 0.05, 1.0));
      }
    }
  });
  return all;
}

// How much a seam through each node would show.
std::vector<double> how_seen(const SeamTask& task, const NodeMeasures& of, const NodePairs& pairs) {
  const SurfaceNodes& nodes = *task.nodes;
  const std::size_t count = nodes.nodes().size();
  std::vector<double> hollow(count, 0), detail(count, 0), degree(count, 0);
  for (const auto& [a, b] : pairs) {
    const Target &p = nodes.nodes()[std::size_t(a)], &q = nodes.nodes()[std::size_t(b)];
    const Vec3 way = (q.position - p.position).normalized();
    hollow[std::size_t(a)] += way.dot(p.normal);
    hollow[std::size_t(b)] -= way.dot(q.normal);
    const double difference = (of.color[std::size_t(a)] - of.color[std::size_t(b)]).norm();
    for (const std::int32_t v : {a, b}) {
      detail[std::size_t(v)] = std::max(detail[std::size_t(v)], difference);
      degree[std::size_t(v)] += 1;
    }
  }
  const Vec3 bare = to_cielab(task.paint.base());
  const bool painted = task.paint.says_anything();
  std::vector<double> seen(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double ink = painted ? std::min(1.0, (of.color[i] - bare).norm() / kFullColor) : 1;
    const double fine = std::min(1.0, detail[i] / kFullDetail);
    const double hollowness = degree[i] > 0 ? 2 * hollow[i] / degree[i] : 0;
    seen[i] = std::max(0.1, of.exposed[i]) * (kAlwaysSeen + kInkSeen * ink + kDetailSeen * fine) *
              std::clamp(1 - hollowness, kHollowSeen, 1.0);
  }
  return seen;
}

// As SeamCosts has them.
void set_dip_costs(const SeamTask& task, const NodeMeasures& of, SeamCosts& all) {
  const std::size_t count = task.nodes->nodes().size(), dips = task.worth.size();
  all.of_dips.resize(count * dips);
  all.cheapest.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const double area_mm2 = task.scale * task.scale * task.nodes->nodes()[i].area;
    const bool any = std::any_of(task.worth.begin(), task.worth.end(),
                                 [&](const std::vector<float>& worth) { return worth[i] > 0; });
    std::int32_t* costs = all.of_dips.data() + i * dips;
    for (std::size_t k = 0; k < dips; ++k) {
      double cost = any ? kLeftBare : 0;
      if (task.worth[k][i] > 0)
        cost = kPoorFilm * (1 - double(task.worth[k][i])) +
               kPoorBorder * (1 - double(of.depth_in[k][i]));
      costs[k] = std::int32_t(std::min(1e9, std::round(kUnit * area_mm2 * cost)));
      if (costs[k] < costs[all.cheapest[i]]) all.cheapest[i] = std::uint8_t(k);
    }
  }
}

std::vector<LabelEdge> edges_between(const NodePairs& pairs, const std::vector<double>& seen,
                                     double spacing_mm) {
  std::vector<LabelEdge> edges;
  edges.reserve(pairs.size());
  for (const auto& [a, b] : pairs)
    edges.push_back({a, b,
                     std::int32_t(std::round(kUnit * spacing_mm / kPairsAcross * 0.5 *
                                             (seen[std::size_t(a)] + seen[std::size_t(b)])))});
  return edges;
}

}  // namespace

SeamCosts seam_costs(const SeamTask& task) {
  NodeMeasures measured = measure_nodes(task);
  const NodePairs pairs = task.nodes->neighbors();
  SeamCosts all;
  set_dip_costs(task, measured, all);
  all.edges =
      edges_between(pairs, how_seen(task, measured, pairs), task.scale * task.nodes->spacing());
  all.inside = std::move(measured.inside);
  return all;
}

double seam_length_mm(const std::vector<LabelEdge>& edges, const std::vector<std::uint8_t>& dip_of,
                      double spacing_mm) {
  const auto cut = std::count_if(edges.begin(), edges.end(), [&](const LabelEdge& edge) {
    return dip_of[std::size_t(edge.a)] != dip_of[std::size_t(edge.b)];
  });
  return double(cut) * spacing_mm / kPairsAcross;
}

}  // namespace hydrodip
