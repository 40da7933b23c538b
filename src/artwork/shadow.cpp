#include "artwork/shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "artwork/incidence.h"
#include "base/disjoint_sets.h"
#include "base/filled.h"
#include "base/parallel.h"

namespace hydrodip {
namespace {

// A surface that turns away by less than this (sine) counts as parallel to the projection.
constexpr double kGrazing = 1e-4;
// A ray starts so far off the surface that rounding does not make it meet its own triangle, and
// more where it leaves at a flat angle.
constexpr double kStart_mm = 1e-3, kStartPerCosine_mm = 4e-5, kFlattest = 0.01;
// From a corner, where triangles meet.
constexpr double kCornerStart_mm = 5e-3;
// On the outline of a patch: so far within it, at most this share of the way to a middle.
constexpr double kWithin_mm = 0.02, kWithin = 0.1;
// Between corners so near each other no shadow falls that could be seen.
constexpr double kSmall_mm = 0.5;
// Where more than such a share of the triangles that may be met would have to be asked everywhere,
// looking for what hangs over them is worth while.
constexpr std::size_t kWorthOneOf = 16;
// Spreads numbers over all bits.
constexpr std::size_t kScatter = 0x9e3779b97f4a7c15U;
// Edges blunter than this are rounded.
constexpr double kBluntCosine = 0.766;  // 40 degrees

std::array<Vec3, 3> corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.positions[std::size_t(t[0])], mesh.positions[std::size_t(t[1])],
          mesh.positions[std::size_t(t[2])]};
}

bool is_small(const std::array<Vec3, 3>& c) {
  constexpr double kMost = kSmall_mm * kSmall_mm;
  return (c[1] - c[0]).squaredNorm() <= kMost && (c[2] - c[1]).squaredNorm() <= kMost &&
         (c[0] - c[2]).squaredNorm() <= kMost;
}

}  // namespace

Shadow::Shadow(const PosedObject& posed, const Projector& projector, const PictureFrame& frame,
               bool closed, bool through)
    : posed_(posed),
      projector_(projector),
      frame_(frame),
      through_(through),
      far_mm_(2 * posed.mesh().bounds().size().norm() + 1),
      states_(filled(posed.mesh().triangles.size(), State::kDark)) {
  if (!through_) side_ = closed ? 1 : side_met();
  parallel_for(states_.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) states_[t] = reach_of(t);
  });
  if (through_) return;
  if (!projector_.has_sides()) settle_small_triangles();
  if (!projector_.has_sides()) darken_what_shows_through_holes();
  look_for_overhangs();
}

void Shadow::look_for_overhangs() {
  const auto dark = std::size_t(std::count(states_.begin(), states_.end(), State::kDark));
  const auto asked = std::size_t(std::count(states_.begin(), states_.end(), State::kAsk));
  if (asked > 0 && asked * kWorthOneOf >= states_.size() - dark) overhang_.emplace(posed_.mesh());
}

Shadow::State Shadow::state_of(int triangle) const {
  return std::atomic_ref(states_[std::size_t(triangle)]).load(std::memory_order_relaxed);
}

// What of a triangle can be known without asking for every point.
Shadow::State Shadow::settled(int triangle) const {
  const State state = state_of(triangle);
  if (state != State::kAsk || !overhang_) return state;
  settle_together(triangle);
  return state_of(triangle);
}

// All near it, as they are asked about next. Those that face away at all their corners are dark
// already; of one that does at some, rays leave both sides, so that it is not clear.
void Shadow::settle_together(int triangle) const {
  const TriangleMesh& mesh = posed_.mesh();
  std::vector<LeavingRays> leaving;
  for (const int t : overhang_->together(triangle)) {
    if (state_of(t) != State::kAsk) continue;
    const Vec3 normal = face_normal(mesh, t);
    const std::array<Vec3, 3> corners = corners_of(mesh, std::size_t(t));
    leaving.push_back({t,
                       {projector_.back(corners[0], normal), projector_.back(corners[1], normal),
                        projector_.back(corners[2], normal)}});
  }
  std::vector<std::uint8_t> clear;
  overhang_->are_clear(leaving, clear);
  for (std::size_t i = 0; i < leaving.size(); ++i)
    std::atomic_ref(states_[std::size_t(leaving[i].triangle)])
        .store(clear[i] ? State::kLit : State::kAskRays, std::memory_order_relaxed);
}

// Before anything is in the way.
Shadow::State Shadow::reach_of(std::size_t triangle) const {
  const TriangleMesh& mesh = posed_.mesh();
  const std::array<Vec3, 3> corners = corners_of(mesh, triangle);
  const Vec3 normal = face_normal(mesh, int(triangle));
  // Where all corners face away, everything between them does.
  bool some = false;
  for (const Vec3& c : corners) some |= faces(normal.dot(projector_.back(c, normal)));
  if (!some) return State::kDark;
  Box2 box;
  for (const Vec3& c : corners) box.add(projector_.flat(c, normal));
  const Vec2 size = box.max - box.min;
  if (size.maxCoeff() <= projector_.curved_mm()) {
    // What bulges between the corners, if the plane is a curved one.
    if (projector_.curved_mm() < 1e300) {
      box.min -= 0.2 * Vec2::Constant(size.maxCoeff());
      box.max += 0.2 * Vec2::Constant(size.maxCoeff());
    }
    if (frame_.misses(box)) return State::kDark;
  }
  return through_ ? State::kLit : State::kAsk;
}

bool Shadow::faces(double cosine) const { return side_ == 0 || side_ * cosine > kGrazing; }

// A surface without an inside has one colour on both sides: which one does the picture meet?
int Shadow::side_met() const {
  constexpr std::size_t kLooks = 2000;
  constexpr double kClearly = 2;
  const TriangleMesh& mesh = posed_.mesh();
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kLooks);
  double towards = 0, away = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const std::array<Vec3, 3> corners = corners_of(mesh, t);
    const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
    const Vec3 normal = face_normal(mesh, int(t));
    const Vec3 back = projector_.back(centre, normal);
    const double cosine = normal.dot(back);
    if (!is_met(centre, back, cosine)) continue;
    const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    (cosine > 0 ? towards : away) += area * std::abs(cosine);
  }
  if (towards > kClearly * away) return 1;
  return away > kClearly * towards ? -1 : 0;
}

bool Shadow::is_met(const Vec3& position, const Vec3& back, double cosine) const {
  const double start = kStart_mm + kStartPerCosine_mm / std::max(std::abs(cosine), kFlattest);
  return !posed_.surface().is_hit(position, back, start, far_mm_);
}

bool Shadow::is_lit(const SurfacePoint& point, const Vec3& position) const {
  const State state = settled(point.triangle);
  if (state == State::kDark || state == State::kLit) return state == State::kLit;
  const Vec3 normal = face_normal(posed_.mesh(), point.triangle);
  const Vec3 back = projector_.back(position, normal);
  const double cosine = normal.dot(back);
  if (!faces(cosine)) return false;
  return is_met(position, back, cosine);
}

// One ray per corner instead of one per question. Only where a corner and all that are joined to it
// agree.
void Shadow::settle_small_triangles() {
  const TriangleMesh& mesh = posed_.mesh();
  enum Corner : std::uint8_t { kUnasked, kAsked, kMet, kHidden };
  std::vector<std::uint8_t> corners = filled<std::uint8_t>(mesh.positions.size(), kUnasked);
  std::vector<std::size_t> small;
  for (std::size_t t = 0; t < states_.size(); ++t) {
    if (states_[t] != State::kAsk || !is_small(corners_of(mesh, t))) continue;
    small.push_back(t);
    for (const std::int32_t v : mesh.triangles[t]) corners[std::size_t(v)] = kAsked;
  }
  if (small.empty()) return;
  parallel_for(corners.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (corners[v] != kAsked) continue;
      const Vec3& p = mesh.positions[v];
      const Vec3 back = projector_.back(p, Vec3::UnitZ());
      corners[v] = posed_.surface().is_hit(p, back, kCornerStart_mm, far_mm_) ? kHidden : kMet;
    }
  });
  std::vector<std::uint8_t> near_met = filled<std::uint8_t>(corners.size(), 0),
                            near_hidden = filled<std::uint8_t>(corners.size(), 0);
  for (const std::size_t t : small) {
    bool met = false, hidden = false;
    for (const std::int32_t v : mesh.triangles[t]) {
      met |= corners[std::size_t(v)] == kMet;
      hidden |= corners[std::size_t(v)] == kHidden;
    }
    for (const std::int32_t v : mesh.triangles[t]) {
      near_met[std::size_t(v)] |= std::uint8_t(met);
      near_hidden[std::size_t(v)] |= std::uint8_t(hidden);
    }
  }
  for (const std::size_t t : small) {
    bool met = false, hidden = false;
    for (const std::int32_t v : mesh.triangles[t]) {
      met |= near_met[std::size_t(v)] != 0;
      hidden |= near_hidden[std::size_t(v)] != 0;
    }
    const Vec3 normal = face_normal(mesh, int(t));
    bool all = true;
    for (const std::int32_t v : mesh.triangles[t])
      all &= faces(normal.dot(projector_.back(mesh.positions[std::size_t(v)], normal)));
    if (!met)
      states_[t] = State::kDark;
    else if (!hidden && all)
      states_[t] = State::kLit;
  }
}

// What faces the projector hangs together in patches. A patch whose outline is in the dark all the
// way round shows, if at all, through a hole: the inside of a far wall, a part behind another.
void Shadow::darken_what_shows_through_holes() {
  if (side_ == 0) return;
  const TriangleMesh& mesh = posed_.mesh();
  std::vector<std::uint8_t> facing = filled<std::uint8_t>(mesh.triangles.size(), 0);
  parallel_for(facing.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<Vec3, 3> c = corners_of(mesh, t);
      const Vec3 normal = face_normal(mesh, int(t));
      facing[t] = faces(normal.dot(projector_.back((c[0] + c[1] + c[2]) / 3, normal)));
    }
  });
  // Corners of the outline: where what faces the projector meets what does not, or ends.
  const auto add = [](std::size_t& sum, std::size_t value) { sum ^= (value + 1) * kScatter; };
  std::vector<std::size_t> ring = filled<std::size_t>(mesh.positions.size(), 0);
  std::vector<std::uint8_t> sides = filled<std::uint8_t>(mesh.positions.size(), 0);
  DisjointSets patches(mesh.positions.size());
  // Where a corner is asked: a hair within its patch, as walls that stand upright on its outline
  // are in nobody's way.
  std::vector<Vec3> within = mesh.positions;
  for (std::size_t t = 0; t < facing.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    const std::array<Vec3, 3> c = corners_of(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = std::size_t(v[k]);
      sides[corner] |= facing[t] ? 1 : 2;
      const Vec3 inwards = (c[0] + c[1] + c[2]) / 3 - c[k];
      if (facing[t])
        within[corner] = c[k] + std::min(kWithin, kWithin_mm / inwards.norm()) * inwards;
      // Around an inner corner every neighbour is met twice.
      add(ring[corner], std::size_t(v[(k + 1) % 3]));
      add(ring[corner], std::size_t(v[(k + 2) % 3]));
    }
    if (!facing[t]) continue;
    patches.join(v[0], v[1]);
    patches.join(v[1], v[2]);
  }
  const auto on_outline = [&](std::size_t v) {
    return sides[v] == 3 || (sides[v] == 1 && ring[v] != 0);
  };
  std::vector<std::uint8_t> lit = filled<std::uint8_t>(mesh.positions.size(), 0);
  parallel_for(lit.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!on_outline(v)) continue;
      const Vec3& p = within[v];
      lit[v] =
          !posed_.surface().is_hit(p, projector_.back(p, Vec3::UnitZ()), kCornerStart_mm, far_mm_);
    }
  });
  std::vector<std::uint8_t> has_lit = filled<std::uint8_t>(mesh.positions.size(), 0);
  for (std::size_t v = 0; v < lit.size(); ++v)
    if (lit[v]) has_lit[patches.find(std::int32_t(v))] = 1;
  // A patch without an outline closes around the projector's centre: it is met everywhere.
  std::vector<std::uint8_t> has_outline = filled<std::uint8_t>(mesh.positions.size(), 0);
  for (std::size_t v = 0; v < lit.size(); ++v)
    if (on_outline(v)) has_outline[patches.find(std::int32_t(v))] = 1;
  for (std::size_t t = 0; t < facing.size(); ++t) {
    const std::size_t patch = patches.find(mesh.triangles[t][0]);
    if (facing[t] && has_outline[patch] && !has_lit[patch]) states_[t] = State::kDark;
  }
}

Slope::Slope(const TriangleMesh& mesh) : corners_(mesh.triangles.size()) {
  const Incidence incidence(mesh);
  parallel_for(mesh.triangles.size(), kElementGrain, [&](std::size_t first, std::size_t end) {
    for (std::size_t t = first; t < end; ++t) {
      const Vec3 own = face_normal(mesh, int(t));
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t other : incidence.around(mesh.triangles[t][k])) {
          const Vec3 normal = face_normal(mesh, int(other));
          if (normal.dot(own) > kBluntCosine) sum += normal;
        }
        corners_[t][k] = (sum.norm() > 0 ? sum.normalized() : own).cast<float>();
      }
    }
  });
}

Vec3 Slope::normal(const SurfacePoint& point) const {
  const auto& c = corners_[std::size_t(point.triangle)];
  const Eigen::Vector3f n =
      float(1 - point.u - point.v) * c[0] + float(point.u) * c[1] + float(point.v) * c[2];
  return n.cast<double>().normalized();
}

}  // namespace hydrodip
