#include "artwork/overhang.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

// Triangles in the smallest boxes, and boxes in a larger one.
constexpr std::size_t kTogether = 16, kChildren = 8;
// Rays start further away from their triangle than that; what is nearer is not met.
constexpr double kOffPlane_mm = 2e-5;
// Neighbours touch the space that rays go through at an edge or a corner: so far within it what
// counts as in the way. Rays are found in single precision, which is coarser.
constexpr double kTouch_mm = 1e-6;
// Flatter rays (cosine) start so near their triangle that nothing is said of them.
constexpr double kFlattest = 0.01;
// Rays along a side of the space may lean out by rounding.
constexpr double kRounding = 1e-9;
// Rays that go more widely apart (cosine to their mean) are not asked together.
constexpr double kWidest = 0.5;
// Sides of the space around several triangles' rays.
constexpr int kSides = 8;

// Every bit of a coordinate in [0, 1) two places further apart than before.
std::uint64_t spread_bits(double coordinate) {
  constexpr int kBits = 20;
  const auto cell = std::uint64_t(std::clamp(coordinate, 0.0, 1.0) * ((1 << kBits) - 1));
  std::uint64_t spread = 0;
  for (int bit = 0; bit < kBits; ++bit) spread |= ((cell >> bit) & 1U) << (3 * bit);
  return spread;
}

double least_outwards(const Box3& box, const Vec3& out) {
  return out.cwiseProduct(box.min).cwiseMin(out.cwiseProduct(box.max)).sum();
}

// A convex polygon with room for the corners that cutting adds: one for each cut.
struct Polygon {
  std::array<Vec3, 12> corners;
  std::size_t count = 0;
  void add(const Vec3& corner) { corners[count++] = corner; }
};

}  // namespace

Overhang::Overhang(const TriangleMesh& mesh)
    : mesh_(mesh), order_(mesh.triangles.size()), place_(mesh.triangles.size()) {
  const Box3 all = mesh.bounds();
  const Vec3 size = all.size().cwiseMax(1e-30);
  std::vector<std::pair<std::uint64_t, int>> along(order_.size());
  parallel_for(along.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Corners c = corners_of(int(t));
      const Vec3 share = ((c[0] + c[1] + c[2]) / 3 - all.min).cwiseQuotient(size);
      along[t] = {
          spread_bits(share.x()) | spread_bits(share.y()) << 1U | spread_bits(share.z()) << 2U,
          int(t)};
    }
  });
  sort_unless_cancelled(along.begin(), along.end(), std::less<>());
  std::vector<Box3> boxes((order_.size() + kTogether - 1) / kTogether);
  parallel_for(boxes.size(), kElementGrain / kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * kTogether; i < std::min(end * kTogether, order_.size()); ++i) {
      order_[i] = along[i].second;
      place_[std::size_t(order_[i])] = int(i);
      for (const Vec3& corner : corners_of(order_[i])) boxes[i / kTogether].add(corner);
    }
  });
  while (boxes.size() > 1) {
    std::vector<Box3> larger((boxes.size() + kChildren - 1) / kChildren);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      larger[i / kChildren].add(boxes[i].min);
      larger[i / kChildren].add(boxes[i].max);
    }
    levels_.push_back(std::exchange(boxes, std::move(larger)));
  }
  levels_.push_back(std::move(boxes));
}

Overhang::Corners Overhang::corners_of(int triangle) const {
  const Triangle& t = mesh_.triangles[std::size_t(triangle)];
  return {mesh_.positions[std::size_t(t[0])], mesh_.positions[std::size_t(t[1])],
          mesh_.positions[std::size_t(t[2])]};
}

std::span<const int> Overhang::together(int triangle) const {
  const std::size_t first = std::size_t(place_[std::size_t(triangle)]) / kTogether * kTogether;
  return std::span(order_).subspan(first, std::min(kTogether, order_.size() - first));
}

void Overhang::are_clear(std::span<const LeavingRays> leaving,
                         std::vector<std::uint8_t>& clear) const {
  clear.assign(leaving.size(), 0);
  std::vector<Candidate> candidates;
  if (const std::vector<HalfSpace> reach = reach_of(leaving); !reach.empty()) {
    look_for(reach, candidates);
    for (std::size_t i = 0; i < leaving.size(); ++i)
      clear[i] = std::uint8_t(is_clear(leaving[i], candidates));
  } else if (leaving.size() > 1) {
    std::vector<std::uint8_t> one;
    for (std::size_t i = 0; i < leaving.size(); ++i) {
      are_clear(leaving.subspan(i, 1), one);
      clear[i] = one[0];
    }
  }
}

// The rays go through what the triangle covers while its corners move along their ways: of several
// half-spaces that hold a triangle and its ways, those along its edges leave the least room.
// Empty: nothing can be said.
std::vector<Overhang::HalfSpace> Overhang::reach_of(const LeavingRays& leaving) const {
  const Corners c = corners_of(leaving.triangle);
  Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  if (!(normal.norm() > 0)) return {};
  normal.normalize();
  if (normal.dot(leaving.ways[0]) < 0) normal = -normal;
  for (const Vec3& way : leaving.ways)
    if (!(normal.dot(way) >= kFlattest)) return {};
  std::vector<HalfSpace> reach;
  reach.push_back({-normal, -normal.dot(c[0]) - kOffPlane_mm});
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = c[k], &b = c[(k + 1) % 3], &opposite = c[(k + 2) % 3];
    // Of rays that go apart, one of the two edge's corners has the way that leans out further.
    for (const Vec3& way : {leaving.ways[k], leaving.ways[(k + 1) % 3]}) {
      Vec3 out = (b - a).cross(way);
      if (!(out.norm() > 0)) continue;
      out.normalize();
      if (out.dot(opposite - a) > 0) out = -out;
      const bool holds_ways =
          std::all_of(leaving.ways.begin(), leaving.ways.end(),
                      [&](const Vec3& other) { return out.dot(other) <= kRounding; });
      if (!holds_ways) continue;
      reach.push_back({out, std::max(out.dot(a), out.dot(b)) - kTouch_mm});
      break;
    }
  }
  return reach;
}

// Of several triangles: half-spaces around all of them. Empty: their ways go too far apart.
std::vector<Overhang::HalfSpace> Overhang::reach_of(std::span<const LeavingRays> leaving) const {
  Vec3 mean = Vec3::Zero();
  for (const LeavingRays& l : leaving)
    for (const Vec3& way : l.ways) mean += way;
  if (!(mean.norm() > 0)) return {};
  mean.normalize();
  for (const LeavingRays& l : leaving)
    for (const Vec3& way : l.ways)
      if (!(mean.dot(way) >= kWidest)) return {};
  const Vec3 across = mean.unitOrthogonal(), along = mean.cross(across);
  std::vector<HalfSpace> reach;
  const auto add = [&](const Vec3& out) {
    HalfSpace half{out, -1e300};
    for (const LeavingRays& l : leaving)
      for (const Vec3& corner : corners_of(l.triangle))
        half.most = std::max(half.most, out.dot(corner));
    reach.push_back(half);
  };
  add(-mean);
  for (int side = 0; side < kSides; ++side) {
    const double turn = 2 * std::numbers::pi * side / kSides;
    const Vec3 out = std::cos(turn) * across + std::sin(turn) * along;
    // Leaned back until all ways lie within.
    double lean = -1e300;
    for (const LeavingRays& l : leaving)
      for (const Vec3& way : l.ways) lean = std::max(lean, out.dot(way) / mean.dot(way));
    add(out - lean * mean);
  }
  return reach;
}

void Overhang::look_for(const std::vector<HalfSpace>& reach,
                        std::vector<Candidate>& candidates) const {
  const auto may_hold = [&](const Box3& box) {
    return std::all_of(reach.begin(), reach.end(), [&](const HalfSpace& half) {
      return least_outwards(box, half.out) <= half.most;
    });
  };
  std::vector<std::pair<std::size_t, std::size_t>> open = {{levels_.size() - 1, 0}};
  while (!open.empty()) {
    const auto [level, box] = open.back();
    open.pop_back();
    if (!may_hold(levels_[level][box])) continue;
    if (level > 0) {
      const std::size_t first = box * kChildren;
      const std::size_t end = std::min(first + kChildren, levels_[level - 1].size());
      for (std::size_t child = first; child < end; ++child) open.emplace_back(level - 1, child);
      continue;
    }
    const std::size_t first = box * kTogether, end = std::min(first + kTogether, order_.size());
    for (std::size_t i = first; i < end; ++i) {
      const Corners corners = corners_of(order_[i]);
      Box3 around;
      for (const Vec3& corner : corners) around.add(corner);
      if (may_hold(around)) candidates.push_back({order_[i], corners});
    }
  }
}

bool Overhang::is_clear(const LeavingRays& leaving,
                        const std::vector<Candidate>& candidates) const {
  const std::vector<HalfSpace> reach = reach_of(leaving);
  if (reach.empty()) return false;
  for (const Candidate& candidate : candidates) {
    if (candidate.triangle == leaving.triangle) continue;
    // What is left of the other triangle within the space.
    Polygon left;
    for (const Vec3& corner : candidate.corners) left.add(corner);
    for (const HalfSpace& half : reach) {
      Polygon cut;
      for (std::size_t k = 0; k < left.count; ++k) {
        const Vec3 &a = left.corners[k], &b = left.corners[(k + 1) % left.count];
        const double over_a = half.out.dot(a) - half.most, over_b = half.out.dot(b) - half.most;
        if (!(over_a > 0)) cut.add(a);
        if ((over_a > 0) != (over_b > 0)) cut.add(a + over_a / (over_a - over_b) * (b - a));
      }
      left = cut;
      if (left.count == 0) break;
    }
    if (left.count > 0) return false;
  }
  return true;
}

}  // namespace hydrodip
