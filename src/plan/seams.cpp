#include "plan/seams.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

}  // namespace

SharedSurface::SharedSurface(const SeamTask& task, const RunContext& context) {
  const RunScope scope(context);
  const std::string stage = "laying the seams";
  context.progress(stage, 0);
  auto data = std::make_shared<Data>();
  data->nodes = task.nodes;
  data->worth = task.worth;
  data->overlap = task.overlap_mm / task.scale;
  const SurfaceNodes& nodes = *task.nodes;
  const std::size_t count = nodes.nodes().size(), dips = task.worth.size();
  const double spacing_mm = task.scale * nodes.spacing();
  const double border = kBorder_mm / task.scale, fade_in = kFadeIn_mm / task.scale;
  const double extent = [&] {
    Box3 box;
    for (const Target& node : nodes.nodes()) box.add(node.position);
    return box.empty() ? 1.0 : 2 * box.size().norm();
  }();

  const std::vector<std::array<std::int32_t, 2>> pairs = nodes.neighbors();
  std::vector<Vec3> color(count);
  std::vector<double> seen(count), hollow(count, 0), detail(count, 0), degree(count, 0);
  const Vec3 bare = to_cielab(task.paint.base());
  data->inside.assign(dips, std::vector<float>(count, 0));
  std::vector<std::vector<float>> depth_in(dips, std::vector<float>(count, 0));
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> close;
    for (std::size_t i = begin; i < end; ++i) {
      check_cancelled();
      const Target& node = nodes.nodes()[i];
      color[i] = to_cielab(task.paint.color_at(node.point));
      seen[i] = exposure(task.surface, node, nodes.spacing(), extent);
      for (std::size_t k = 0; k < dips; ++k) {
        if (!(task.worth[k][i] > 0)) continue;
        const double to_border = distance_to(
            nodes, node, border, close, [&](std::size_t j) { return !(task.worth[k][j] > 0); });
        depth_in[k][i] = float(to_border / border);
        data->inside[k][i] = float(std::clamp(to_border / fade_in, 0.05, 1.0));
      }
    }
  });
  context.progress(stage, 0.3);
  for (const auto& [a, b] : pairs) {
    const Target &p = nodes.nodes()[std::size_t(a)], &q = nodes.nodes()[std::size_t(b)];
    const Vec3 way = (q.position - p.position).normalized();
    hollow[std::size_t(a)] += way.dot(p.normal);
    hollow[std::size_t(b)] -= way.dot(q.normal);
    const double difference = (color[std::size_t(a)] - color[std::size_t(b)]).norm();
    for (const std::int32_t v : {a, b}) {
      detail[std::size_t(v)] = std::max(detail[std::size_t(v)], difference);
      degree[std::size_t(v)] += 1;
    }
  }
  const bool painted = task.paint.says_anything();
  for (std::size_t i = 0; i < count; ++i) {
    const double ink = painted ? std::min(1.0, (color[i] - bare).norm() / kFullColor) : 1;
    const double fine = std::min(1.0, detail[i] / kFullDetail);
    const double hollowness = degree[i] > 0 ? 2 * hollow[i] / degree[i] : 0;
    seen[i] = std::max(0.1, seen[i]) * (kAlwaysSeen + kInkSeen * ink + kDetailSeen * fine) *
              std::clamp(1 - hollowness, kHollowSeen, 1.0);
  }

  std::vector<std::int32_t> costs(count * dips);
  std::vector<std::uint8_t> start(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const double area_mm2 = task.scale * task.scale * nodes.nodes()[i].area;
    bool any = false;
    for (std::size_t k = 0; k < dips; ++k) any = any || task.worth[k][i] > 0;
    for (std::size_t k = 0; k < dips; ++k) {
      double cost = any ? kLeftBare : 0;
      if (task.worth[k][i] > 0)
        cost =
            kPoorFilm * (1 - double(task.worth[k][i])) + kPoorBorder * (1 - double(depth_in[k][i]));
      costs[i * dips + k] = std::int32_t(std::min(1e9, std::round(kUnit * area_mm2 * cost)));
      if (costs[i * dips + k] < costs[i * dips + start[i]]) start[i] = std::uint8_t(k);
    }
  }
  std::vector<LabelEdge> edges;
  edges.reserve(pairs.size());
  for (const auto& [a, b] : pairs)
    edges.push_back({a, b,
                     std::int32_t(std::round(kUnit * spacing_mm / kPairsAcross * 0.5 *
                                             (seen[std::size_t(a)] + seen[std::size_t(b)])))});
  context.progress(stage, 0.4);
  data->dip_of = best_labels(int(dips), costs, edges, std::move(start));
  context.progress(stage, 0.9);

  std::size_t cut = 0;
  for (const LabelEdge& edge : edges)
    cut += data->dip_of[std::size_t(edge.a)] != data->dip_of[std::size_t(edge.b)] ? 1 : 0;
  data->seam_mm = double(cut) * spacing_mm / kPairsAcross;
  data->at_seam.assign(count, 0);
  const double reach = data->overlap + 2 * nodes.spacing();
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> close;
    for (std::size_t i = begin; i < end; ++i) {
      check_cancelled();
      const Target& node = nodes.nodes()[i];
      nodes.near(node.position, node.normal, reach, close);
      data->at_seam[i] = std::any_of(close.begin(), close.end(), [&](std::int32_t j) {
        return data->dip_of[std::size_t(j)] != data->dip_of[i];
      });
    }
  });
  data_ = std::move(data);
  context.progress(stage, 1);
}

std::vector<float> SharedSurface::shares_at(const Vec3& position, const Vec3& normal) const {
  const Data& d = *data_;
  const SurfaceNodes& nodes = *d.nodes;
  std::vector<float> shares(d.worth.size(), 0);
  std::vector<std::int32_t> close;
  double reach = 2 * nodes.spacing();
  nodes.near(position, normal, reach, close);
  if (close.empty()) {
    reach = 8 * nodes.spacing();
    nodes.near(position, normal, reach, close);
  }
  std::int32_t nearest = -1;
  double least = 1e300;
  for (const std::int32_t j : close) {
    const double distance = (nodes.nodes()[std::size_t(j)].position - position).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = j;
  }
  if (nearest < 0) {
    shares[0] = 1;
    return shares;
  }
  if (!d.at_seam[std::size_t(nearest)]) {
    shares[d.dip_of[std::size_t(nearest)]] = 1;
    return shares;
  }
  // How far each dip's part is; equally far from two is on the seam.
  nodes.near(position, normal, d.overlap + 2 * nodes.spacing(), close);
  std::vector<double> distance(shares.size(), 1e300);
  for (const std::int32_t j : close) {
    double& so_far = distance[d.dip_of[std::size_t(j)]];
    so_far = std::min(so_far, (nodes.nodes()[std::size_t(j)].position - position).norm());
  }
  const double own = *std::min_element(distance.begin(), distance.end());
  double sum = 0;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    // From 0 on the seam to 1 where the fade ends; two dips' shares are then linear in it.
    const double t = d.overlap > 0 ? std::clamp(2 * (distance[k] - own) / d.overlap, 0.0, 1.0)
                                   : (distance[k] > own ? 1.0 : 0.0);
    shares[k] = float((1 - t) / (1 + t)) * d.inside[k][std::size_t(nearest)];
    sum += double(shares[k]);
  }
  if (!(sum > 0)) {
    shares[d.dip_of[std::size_t(nearest)]] = 1;
    return shares;
  }
  for (float& share : shares) share = float(double(share) / sum);
  return shares;
}

Allotment SharedSurface::allotment(std::size_t dip,
                                   std::shared_ptr<const TriangleMesh> mesh) const {
  return Allotment([shared = *this, dip, mesh = std::move(mesh)](const SurfacePoint& point) {
    return shared.shares_at(position_at(*mesh, point), face_normal(*mesh, point.triangle))[dip];
  });
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
