#include "plan/seams.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "base/run_scope.h"
#include "plan/labelling.h"
#include "plan/seam_costs.h"

namespace hydrodip {
namespace {

// A point further from all nodes than so many spacings belongs to the first dip.
constexpr double kFarthest = 8;
// What may lie just as far is looked for a hair further.
constexpr double kHair = 1 + 1e-9;

using Corners = std::array<Vec3, 3>;

// Sets of dips.
static_assert(kMostDips < 29);
constexpr std::uint32_t kAllDips = ~std::uint32_t(0);
constexpr std::uint32_t bit_of(std::size_t dip) { return std::uint32_t(1) << dip; }

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
  SeamCosts costs = seam_costs(task);
  context.progress(activity, 0.4);

  auto data = std::make_shared<Data>();
  data->nodes = task.nodes;
  data->worth = task.worth;
  data->overlap = task.overlap_mm / task.scale;
  data->inside = std::move(costs.inside);
  data->dip_of =
      best_labels(int(task.worth.size()), costs.of_dips, costs.edges, std::move(costs.cheapest));
  context.progress(activity, 0.9);
  data->seam_mm = seam_length_mm(costs.edges, data->dip_of, task.scale * task.nodes->spacing());
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
    const std::uint32_t near = looked_at(point.triangle);
    if (const auto share = share_over(dip, near)) return *share;
    const Vec3 position = position_at(*mesh_, point), normal = face_normal(*mesh_, point.triangle);
    const Place place = shared_.place_of(position, normal);
    if (place.alone) return place.dip == dip ? 1 : 0;
    return shared_.faded_at(place, position, normal, near)[dip];
  }

  // Of all points of a triangle, where they have one.
  std::optional<float> share_over(std::size_t dip, int triangle) const {
    return share_over(dip, looked_at(triangle));
  }

 private:
  // Besides the bits of dips: a node is near every point, so that dips further away have no part;
  // and no seam is near any of it.
  static constexpr std::uint32_t kSeen = bit_of(31), kWhole = bit_of(30), kCovered = bit_of(29);

  static std::optional<float> share_over(std::size_t dip, std::uint32_t near) {
    if ((near & (kWhole | kCovered)) && !(near & bit_of(dip))) return 0.0F;
    if (near & kWhole) return 1.0F;
    return std::nullopt;
  }

  std::uint32_t looked_at(int triangle) const {
    std::atomic<std::uint32_t>& known = known_[std::size_t(triangle)];
    std::uint32_t near = known.load(std::memory_order_relaxed);
    if (near == 0) known.store(near = look_at(triangle), std::memory_order_relaxed);
    return near;
  }

  // The dips that may have a part anywhere in it.
  std::uint32_t look_at(int triangle) const {
    const Data& d = *shared_.data_;
    const Corners corners = corners_of(triangle);
    const Vec3 center = (corners[0] + corners[1] + corners[2]) / 3,
               normal = face_normal(*mesh_, triangle);
    double radius = 0;
    for (const Vec3& corner : corners) radius = std::max(radius, (corner - center).norm());
    radius *= kHair;
    std::uint32_t near = kSeen | whole_or_covered(corners, center, radius, normal);
    if (near & kWhole) return near;
    for (std::size_t k = 0; k < d.nearest.size(); ++k)
      if (d.nearest[k]
              .find(center, normal, kHair * (d.overlap + 2 * d.nodes->spacing()) + radius)
              .node >= 0)
        near |= bit_of(k);
    return near;
  }

  // kCovered or nothing; kWhole and the one dip of all nodes that may be the nearest to a point of
  // the triangle, if no seam is near any of them.
  std::uint32_t whole_or_covered(const Corners& corners, const Vec3& center, double radius,
                                 const Vec3& normal) const {
    const Data& d = *shared_.data_;
    const double reach = 2 * d.nodes->spacing();
    std::vector<std::int32_t> close;
    d.nodes->near(center, normal, kHair * reach + radius, close);
    const bool is_covered = std::any_of(close.begin(), close.end(), [&](std::int32_t j) {
      const Vec3& at = d.nodes->nodes()[std::size_t(j)].position;
      return std::all_of(corners.begin(), corners.end(),
                         [&](const Vec3& p) { return kHair * (at - p).norm() < reach; });
    });
    if (!is_covered) return 0;
    const std::uint8_t dip = d.dip_of[std::size_t(close[0])];
    const bool is_whole = std::all_of(close.begin(), close.end(), [&](std::int32_t j) {
      return !d.at_seam[std::size_t(j)] && d.dip_of[std::size_t(j)] == dip;
    });
    return is_whole ? kWhole | bit_of(dip) : kCovered;
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
        [triangles, k](const SurfacePoint& point) { return triangles->share_at(k, point); },
        [triangles, k](int triangle) { return triangles->share_over(k, triangle); });
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
