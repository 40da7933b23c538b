#include "plan/seams.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "base/run_scope.h"
#include "image/color_difference.h"
#include "plan/labelling.h"

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

// A point further from all nodes than so many spacings belongs to the first dip.
constexpr double kFarthest = 8;
// What may lie just as far is looked for a hair further.
constexpr double kHair = 1 + 1e-9;

using Corners = std::array<Vec3, 3>;

// Sets of dips.
static_assert(kMostDips < 30);
constexpr std::uint32_t kAllDips = ~std::uint32_t(0);
constexpr std::uint32_t bit_of(std::size_t dip) { return std::uint32_t(1) << dip; }

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

// How far a point lies from the nearest node of which `is_out` is true, at most `reach`.
template <class IsOut>
double distance_to(const SurfaceNodes& nodes, const Target& node, double reach,
                   std::vector<std::int32_t>& close, const IsOut& is_out) {
  nodes.near(node.position, node.normal, reach, close);
  double least = reach;
  for (const std::int32_t j : close)
    if (is_out(std::size_t(j)))
      least = std::min(least, (nodes.nodes()[std::size_t(j)].position - node.position).norm());
  return least;
}

using NodePairs = std::vector<std::array<std::int32_t, 2>>;

// Per node, and of films per dip and node.
struct NodeMeasures {
  std::vector<Vec3> color;                   // CIELAB
  std::vector<double> exposed;               // share of the half space above
  std::vector<std::vector<float>> depth_in;  // from the film's border: 0 to 1 at kBorder_mm
  std::vector<std::vector<float>> inside;    // as SharedSurface::Data::inside
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
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> close;
    for (std::size_t i = begin; i < end; ++i) {
      check_cancelled();
      const Target& node = nodes.nodes()[i];
      all.color[i] = to_cielab(task.paint.color_at(node.point));
      all.exposed[i] = exposure(task.surface, node, nodes.spacing(), extent);
      for (std::size_t k = 0; k < dips; ++k) {
        if (!(task.worth[k][i] > 0)) continue;
        const double to_border = distance_to(
            nodes, node, border, close, [&](std::size_t j) { return !(task.worth[k][j] > 0); });
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

// What each node costs as each dip's part, and the dip that is cheapest.
struct DipCosts {
  std::vector<std::int32_t> costs;  // node by node
  std::vector<std::uint8_t> cheapest;
};

DipCosts dip_costs(const SeamTask& task, const NodeMeasures& of) {
  const std::size_t count = task.nodes->nodes().size(), dips = task.worth.size();
  DipCosts all{std::vector<std::int32_t>(count * dips), std::vector<std::uint8_t>(count, 0)};
  for (std::size_t i = 0; i < count; ++i) {
    const double area_mm2 = task.scale * task.scale * task.nodes->nodes()[i].area;
    const bool any = std::any_of(task.worth.begin(), task.worth.end(),
                                 [&](const std::vector<float>& worth) { return worth[i] > 0; });
    std::int32_t* costs = all.costs.data() + i * dips;
    for (std::size_t k = 0; k < dips; ++k) {
      double cost = any ? kLeftBare : 0;
      if (task.worth[k][i] > 0)
        cost = kPoorFilm * (1 - double(task.worth[k][i])) +
               kPoorBorder * (1 - double(of.depth_in[k][i]));
      costs[k] = std::int32_t(std::min(1e9, std::round(kUnit * area_mm2 * cost)));
      if (costs[k] < costs[all.cheapest[i]]) all.cheapest[i] = std::uint8_t(k);
    }
  }
  return all;
}

std::vector<LabelEdge> seam_costs(const NodePairs& pairs, const std::vector<double>& seen,
                                  double spacing_mm) {
  std::vector<LabelEdge> edges;
  edges.reserve(pairs.size());
  for (const auto& [a, b] : pairs)
    edges.push_back({a, b,
                     std::int32_t(std::round(kUnit * spacing_mm / kPairsAcross * 0.5 *
                                             (seen[std::size_t(a)] + seen[std::size_t(b)])))});
  return edges;
}

double length_mm(const std::vector<LabelEdge>& edges, const std::vector<std::uint8_t>& dip_of,
                 double spacing_mm) {
  const auto cut = std::count_if(edges.begin(), edges.end(), [&](const LabelEdge& edge) {
    return dip_of[std::size_t(edge.a)] != dip_of[std::size_t(edge.b)];
  });
  return double(cut) * spacing_mm / kPairsAcross;
}

// Of each dip's part.
std::vector<NearestNode> nearest_of_parts(const SurfaceNodes& nodes,
                                          const std::vector<std::uint8_t>& dip_of,
                                          std::size_t dips) {
  std::vector<std::vector<std::int32_t>> parts(dips);
  for (std::size_t i = 0; i < dip_of.size(); ++i) parts[dip_of[i]].push_back(std::int32_t(i));
  std::vector<NearestNode> nearest;
  nearest.reserve(dips);
  for (const auto& part : parts) nearest.emplace_back(nodes, part);
  return nearest;
}

// Nodes that have one of another dip within reach.
std::vector<std::uint8_t> near_seams(const SurfaceNodes& nodes,
                                     const std::vector<std::uint8_t>& dip_of,
                                     const std::vector<NearestNode>& nearest, double reach) {
  std::vector<std::uint8_t> at_seam(dip_of.size(), 0);
  parallel_for(dip_of.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      check_cancelled();
      const Target& node = nodes.nodes()[i];
      for (std::size_t k = 0; k < nearest.size() && !at_seam[i]; ++k)
        at_seam[i] = k != dip_of[i] && nearest[k].find(node.position, node.normal, reach).node >= 0;
    }
  });
  return at_seam;
}

}  // namespace

SharedSurface::SharedSurface(const SeamTask& task, const RunContext& context) {
  const RunScope scope(context);
  const std::string activity = "laying the seams";
  context.progress(activity, 0);
  NodeMeasures measured = measure_nodes(task);
  context.progress(activity, 0.3);
  const double spacing_mm = task.scale * task.nodes->spacing();
  const NodePairs pairs = task.nodes->neighbors();
  const std::vector<LabelEdge> edges =
      seam_costs(pairs, how_seen(task, measured, pairs), spacing_mm);
  DipCosts costs = dip_costs(task, measured);
  context.progress(activity, 0.4);

  auto data = std::make_shared<Data>();
  data->nodes = task.nodes;
  data->worth = task.worth;
  data->overlap = task.overlap_mm / task.scale;
  data->inside = std::move(measured.inside);
  data->dip_of = best_labels(int(task.worth.size()), costs.costs, edges, std::move(costs.cheapest));
  context.progress(activity, 0.9);
  data->seam_mm = length_mm(edges, data->dip_of, spacing_mm);
  std::vector<std::int32_t> all(task.nodes->nodes().size());
  std::iota(all.begin(), all.end(), 0);
  data->nearest_of_all = NearestNode(*task.nodes, all);
  data->nearest = nearest_of_parts(*task.nodes, data->dip_of, task.worth.size());
  data->at_seam = near_seams(*task.nodes, data->dip_of, data->nearest,
                             data->overlap + 2 * task.nodes->spacing());
  data_ = std::move(data);
  context.progress(activity, 1);
}

SharedSurface::Place SharedSurface::place_of(const Vec3& position, const Vec3& normal) const {
  const Data& d = *data_;
  const auto found = d.nearest_of_all.find(position, normal, kFarthest * d.nodes->spacing());
  if (found.node < 0) return {-1, 0, 0, true};
  const auto node = std::size_t(found.node);
  return {found.node, found.squared, d.dip_of[node], !d.at_seam[node]};
}

std::vector<float> SharedSurface::shares_at(const Vec3& position, const Vec3& normal) const {
  const Place place = place_of(position, normal);
  if (!place.alone) return faded_at(place, position, normal, kAllDips);
  std::vector<float> shares(dips(), 0);
  shares[place.dip] = 1;
  return shares;
}

std::vector<float> SharedSurface::faded_at(const Place& place, const Vec3& position,
                                           const Vec3& normal, std::uint32_t near) const {
  const Data& d = *data_;
  std::vector<float> shares(dips(), 0);
  // How far each dip's part is; equally far from two is on the seam. What is further than a fade
  // beyond the nearest has no share, however far it is.
  double within = d.overlap + 2 * d.nodes->spacing();
  std::vector<double> distance(dips(), 1e300);
  if (place.squared <= within * within) distance[place.dip] = std::sqrt(place.squared);
  const double own = distance[place.dip];
  within = std::min(within, kHair * (own + 0.5 * d.overlap));
  for (std::size_t k = 0; k < distance.size(); ++k) {
    if (k == place.dip || !(near & bit_of(k))) continue;
    const auto found = d.nearest[k].find(position, normal, within);
    if (found.node >= 0) distance[k] = std::sqrt(found.squared);
  }
  double sum = 0;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    // From 0 on the seam to 1 where the fade ends; two dips' shares are then linear in it.
    const double t = d.overlap > 0 ? std::clamp(2 * (distance[k] - own) / d.overlap, 0.0, 1.0)
                                   : (distance[k] > own ? 1.0 : 0.0);
    shares[k] = float((1 - t) / (1 + t)) * d.inside[k][std::size_t(place.nearest)];
    sum += double(shares[k]);
  }
  if (!(sum > 0)) {
    shares[place.dip] = 1;
    return shares;
  }
  for (float& share : shares) share = float(double(share) / sum);
  return shares;
}

// What is asked of points of a mesh; of its triangles it is found once what all their points share.
class SharedSurface::Triangles {
 public:
  Triangles(SharedSurface shared, std::shared_ptr<const TriangleMesh> mesh)
      : shared_(std::move(shared)), mesh_(std::move(mesh)), known_(mesh_->triangles.size()) {}

  float share_at(std::size_t dip, const SurfacePoint& point) const {
    std::atomic<std::uint32_t>& known = known_[std::size_t(point.triangle)];
    std::uint32_t near = known.load(std::memory_order_relaxed);
    if (near == 0) known.store(near = look_at(point.triangle), std::memory_order_relaxed);
    if (near & kWhole) return near & bit_of(dip) ? 1 : 0;
    const Vec3 position = position_at(*mesh_, point), normal = face_normal(*mesh_, point.triangle);
    const Place place = shared_.place_of(position, normal);
    if (place.alone) return place.dip == dip ? 1 : 0;
    return shared_.faded_at(place, position, normal, near)[dip];
  }

 private:
  static constexpr std::uint32_t kSeen = bit_of(31), kWhole = bit_of(30);

  // The dips that may have a part anywhere in it; kWhole: it is one dip's.
  std::uint32_t look_at(int triangle) const {
    const Data& d = *shared_.data_;
    const Corners corners = corners_of(triangle);
    const Vec3 center = (corners[0] + corners[1] + corners[2]) / 3,
               normal = face_normal(*mesh_, triangle);
    double radius = 0;
    for (const Vec3& corner : corners) radius = std::max(radius, (corner - center).norm());
    radius *= kHair;
    const std::uint32_t whole = whole_part(corners, center, radius, normal);
    if (whole != 0) return kSeen | kWhole | whole;
    std::uint32_t near = kSeen;
    for (std::size_t k = 0; k < d.nearest.size(); ++k)
      if (d.nearest[k]
              .find(center, normal, kHair * (d.overlap + 2 * d.nodes->spacing()) + radius)
              .node >= 0)
        near |= bit_of(k);
    return near;
  }

  // The one dip of all nodes that may be the nearest to a point of the triangle, if no seam is near
  // any of them.
  std::uint32_t whole_part(const Corners& corners, const Vec3& center, double radius,
                           const Vec3& normal) const {
    const Data& d = *shared_.data_;
    const double reach = 2 * d.nodes->spacing();
    std::vector<std::int32_t> close;
    d.nodes->near(center, normal, kHair * reach + radius, close);
    bool is_one_near_all = false;
    for (const std::int32_t j : close) {
      if (d.at_seam[std::size_t(j)] || d.dip_of[std::size_t(j)] != d.dip_of[std::size_t(close[0])])
        return 0;
      const Vec3& at = d.nodes->nodes()[std::size_t(j)].position;
      is_one_near_all |= std::all_of(corners.begin(), corners.end(),
                                     [&](const Vec3& p) { return (at - p).norm() < reach; });
    }
    return is_one_near_all ? bit_of(d.dip_of[std::size_t(close[0])]) : 0;
  }

  Corners corners_of(int triangle) const {
    Corners corners;
    for (int i = 0; i < 3; ++i)
      corners[std::size_t(i)] =
          mesh_->positions[std::size_t(mesh_->triangles[std::size_t(triangle)][i])];
    return corners;
  }

  SharedSurface shared_;
  std::shared_ptr<const TriangleMesh> mesh_;
  mutable std::vector<std::atomic<std::uint32_t>> known_;  // bits of dips; 0: not looked at yet
};

std::vector<Allotment> SharedSurface::allotments(std::shared_ptr<const TriangleMesh> mesh) const {
  const auto triangles = std::make_shared<const Triangles>(*this, std::move(mesh));
  std::vector<Allotment> all;
  for (std::size_t k = 0; k < dips(); ++k)
    all.emplace_back(
        [triangles, k](const SurfacePoint& point) { return triangles->share_at(k, point); });
  return all;
}

std::vector<std::int32_t> SharedSurface::seam_nodes() const {
  std::vector<std::int32_t> found;
  const auto& nodes = data_->nodes->nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!data_->at_seam[i]) continue;
    const std::vector<float> shares = shares_at(nodes[i].position, nodes[i].normal);
    if (*std::max_element(shares.begin(), shares.end()) < 0.995F) found.push_back(std::int32_t(i));
  }
  return found;
}

std::vector<double> SharedSurface::shares_of_surface() const {
  std::vector<double> shares(dips(), 0);
  const Targets& targets = data_->nodes->targets();
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    const std::uint8_t k = data_->dip_of[i];
    if (data_->worth[k][i] > 0) shares[k] += targets.list[i].area / targets.area;
  }
  return shares;
}

}  // namespace hydrodip
