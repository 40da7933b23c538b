#include "artwork/geodesic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <unordered_map>
#include <utility>

#include "artwork/incidence.h"
#include "base/filled.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
// A way that is shorter by less is no shorter.
constexpr double kShorter = 1 - 1e-11;
// Ways to what is near enough may lead along what is a little farther.
constexpr double kBeyond = 1.3;

// ---- a finer mesh ----

// Fine vertices of one coarse triangle: row i (towards corner 2 it counts down), column j.
class FineVertices {
 public:
  FineVertices(const TriangleMesh& coarse, int per_side, TriangleMesh& fine)
      : coarse_(coarse), n_(per_side), fine_(fine) {
    fine_.positions = coarse.positions;
  }

  // At (i, j) / n of the way to corner 1 and 2.
  std::int32_t at(std::size_t triangle, int i, int j, std::vector<std::int32_t>& inner) {
    const Triangle& t = coarse_.triangles[triangle];
    const int rest = n_ - i - j;
    if (i == n_) return t[1];
    if (j == n_) return t[2];
    if (rest == n_) return t[0];
    if (j == 0) return on_edge(t[0], t[1], i);
    if (i == 0) return on_edge(t[0], t[2], j);
    if (rest == 0) return on_edge(t[1], t[2], j);
    std::int32_t& known = inner[std::size_t(i) * std::size_t(n_) + std::size_t(j)];
    if (known < 0) {
      known = std::int32_t(fine_.positions.size());
      fine_.positions.push_back((rest * corner(t[0]) + i * corner(t[1]) + j * corner(t[2])) / n_);
    }
    return known;
  }

 private:
  const Vec3& corner(std::int32_t v) const { return coarse_.positions[std::size_t(v)]; }

  // The same from both triangles of an edge.
  std::int32_t on_edge(std::int32_t a, std::int32_t b, int steps) {
    if (a > b) {
      std::swap(a, b);
      steps = n_ - steps;
    }
    const auto key = std::uint64_t(std::uint32_t(a)) << 32U | std::uint32_t(b);
    const auto [first, is_new] = edges_.try_emplace(key, std::int32_t(fine_.positions.size()));
    if (is_new)
      for (int k = 1; k < n_; ++k)
        fine_.positions.push_back(((n_ - k) * corner(a) + k * corner(b)) / n_);
    return first->second + steps - 1;
  }

  const TriangleMesh& coarse_;
  int n_;
  TriangleMesh& fine_;
  std::unordered_map<std::uint64_t, std::int32_t> edges_;
};

// ---- polar coordinates ----

double wrapped(double angle) {
  return angle - 2 * std::numbers::pi * std::round(angle / (2 * std::numbers::pi));
}

struct Polar {
  double distance = kFar, angle = 0;
};

// Of a triangle's third corner, from the two others: the centre unrolled into the triangle's plane.
class Unrolled {
 public:
  Unrolled(const Vec3& j, const Vec3& k, const Vec3& i, const Polar& at_j, const Polar& at_k)
      : at_j_(at_j), at_k_(at_k) {
    const Vec3 along = k - j;
    edge_ = along.norm();
    const Vec3 to_i = i - j;
    i_.x() = to_i.dot(along) / edge_;
    i_.y() = std::sqrt(std::max(0.0, to_i.squaredNorm() - i_.x() * i_.x()));
  }

  Polar at_i() const {
    const double x =
        (at_j_.distance * at_j_.distance + edge_ * edge_ - at_k_.distance * at_k_.distance) /
        (2 * edge_);
    const double height2 = at_j_.distance * at_j_.distance - x * x;
    if (height2 > 0) {
      const Vec2 centre(x, -std::sqrt(height2));
      const double crossing =
          centre.x() + (i_.x() - centre.x()) * -centre.y() / (i_.y() - centre.y());
      if (crossing >= 0 && crossing <= edge_) return straight(centre);
    }
    const double by_j = at_j_.distance + i_.norm();
    const double by_k = at_k_.distance + (i_ - Vec2(edge_, 0)).norm();
    return by_j <= by_k ? Polar{by_j, at_j_.angle} : Polar{by_k, at_k_.angle};
  }

 private:
  Polar straight(const Vec2& centre) const {
    const Vec2 to_j = -centre, to_k = Vec2(edge_, 0) - centre, to_i = i_ - centre;
    const double whole = std::atan2(std::abs(cross2(to_j, to_k)), to_j.dot(to_k));
    const double part = std::atan2(std::abs(cross2(to_j, to_i)), to_j.dot(to_i));
    const double share = whole > 0 ? part / whole : 0;
    return {to_i.norm(), at_j_.angle + share * wrapped(at_k_.angle - at_j_.angle)};
  }

  const Polar& at_j_;
  const Polar& at_k_;
  double edge_ = 0;
  Vec2 i_;
};

class Spreading {
 public:
  Spreading(const TriangleMesh& mesh, double farthest_mm)
      : mesh_(mesh), farthest_(farthest_mm), polar_(mesh.positions.size()), incidence_(mesh) {}

  void start(std::int32_t v, const Polar& polar) { offer(v, polar); }

  void run() {
    CheckEvery check(1 << 12);
    while (!front_.empty()) {
      check();
      const auto [distance, v] = front_.top();
      front_.pop();
      if (distance > polar_[std::size_t(v)].distance || distance > farthest_) continue;
      for (const std::uint32_t t : incidence_.around(v)) spread(v, mesh_.triangles[t]);
    }
  }

  const std::vector<Polar>& polar() const { return polar_; }

 private:
  void spread(std::int32_t from, const Triangle& t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t to = t[k];
      if (to == from) continue;
      const std::int32_t other = from == t[(k + 1) % 3] ? t[(k + 2) % 3] : t[(k + 1) % 3];
      const Polar& at_from = polar_[std::size_t(from)];
      const Polar& at_other = polar_[std::size_t(other)];
      const Vec3& p = mesh_.positions[std::size_t(from)];
      const Vec3& q = mesh_.positions[std::size_t(to)];
      if (at_other.distance < kFar)
        offer(to, Unrolled(p, mesh_.positions[std::size_t(other)], q, at_from, at_other).at_i());
      else
        offer(to, {at_from.distance + (q - p).norm(), at_from.angle});
    }
  }

  void offer(std::int32_t v, const Polar& polar) {
    Polar& known = polar_[std::size_t(v)];
    if (!(polar.distance < kShorter * known.distance)) return;
    known = polar;
    front_.emplace(polar.distance, v);
  }

  using Entry = std::pair<double, std::int32_t>;
  const TriangleMesh& mesh_;
  double farthest_;
  std::vector<Polar> polar_;
  Incidence incidence_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front_;
};

// ---- even directions ----

// A row of corners keeps all of its curvature to itself: ways to the left and to the right of it
// disagree, where a smooth surface would spread the difference. Directions are evened out between
// neighbours by mean value weights, which leave a plane, and all that can be unrolled into one, as
// it is; distances stay.
class Evening {
 public:
  Evening(const TriangleMesh& mesh, std::vector<Vec2>& place) : mesh_(mesh), place_(place) {
    const std::size_t count = mesh.positions.size();
    angle_ = filled(count, 0.0);
    edge_ = filled(count, 0.0);
    fan_ = filled<std::int64_t>(count, 0);
    whole_ = filled<std::uint8_t>(count, 1);
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) look_at(t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
      if (place_[std::size_t(t[0])].allFinite()) reached_.push_back(t);
    }
  }

  void run(int rounds) {
    for (int round = 0; round < rounds; ++round) {
      check_cancelled();
      step();
    }
  }

 private:
  Vec3 way(std::int32_t from, std::int32_t to) const {
    return mesh_.positions[std::size_t(to)] - mesh_.positions[std::size_t(from)];
  }
  const Vec2& place(std::int32_t v) const { return place_[std::size_t(v)]; }

  static double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }

  // Corners in the midst of reached surface that is not torn there.
  void look_at(std::int32_t v, std::int32_t a, std::int32_t b) {
    constexpr double kTorn = 3;
    const auto i = std::size_t(v);
    angle_[i] += angle_between(way(v, a), way(v, b));
    edge_[i] = std::max(edge_[i], way(v, a).norm());
    fan_[i] += std::int64_t(a) - std::int64_t(b);  // comes back to 0 around the corner
    for (const std::int32_t other : {a, b})
      whole_[i] &= std::uint8_t(place(v).allFinite() && place(other).allFinite() &&
                                (place(v) - place(other)).norm() < kTorn * way(v, other).norm());
  }

  void step() {
    constexpr double kNear = 5;  // edges
    std::vector<Vec2> sum = filled(place_.size(), Vec2(0, 0));
    std::vector<double> total = filled(place_.size(), 0.0);
    for (const Triangle& t : reached_)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t v = t[k], a = t[(k + 1) % 3], b = t[(k + 2) % 3];
        const auto i = std::size_t(v);
        if (!whole_[i] || fan_[i] != 0) continue;
        const double share = angle_between(way(v, a), way(v, b)) / angle_[i];
        const double half = std::tan(std::min(share * std::numbers::pi, 1.5));
        for (const std::int32_t other : {a, b}) {
          const double weight = half / way(v, other).norm();
          sum[i] += weight * place(other);
          total[i] += weight;
        }
      }
    for (std::size_t i = 0; i < place_.size(); ++i) {
      if (!(total[i] > 0)) continue;
      // Next to the centre every way is straight anyway.
      const double distance = place_[i].norm();
      const double part = 0.5 * std::clamp(distance / (kNear * edge_[i]) - 1, 0.0, 1.0);
      const Vec2 next = (1 - part) * place_[i] + part * sum[i] / total[i];
      if (next.norm() > 0.5 * distance) place_[i] = distance / next.norm() * next;
    }
  }

  const TriangleMesh& mesh_;
  std::vector<Vec2>& place_;
  std::vector<Triangle> reached_;
  std::vector<double> angle_, edge_;
  std::vector<std::int64_t> fan_;
  std::vector<std::uint8_t> whole_;
};

}  // namespace

FineMesh::FineMesh(const TriangleMesh& mesh, int per_side) : per_side_(per_side) {
  if (per_side_ <= 1) {
    per_side_ = 1;
    mesh_ = mesh;
    return;
  }
  const int n = per_side_;
  FineVertices vertices(mesh, n, mesh_);
  std::vector<std::int32_t> inner;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    check_cancelled();
    inner.assign(std::size_t(n) * std::size_t(n), -1);
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const std::int32_t a = vertices.at(t, i, j, inner), b = vertices.at(t, i + 1, j, inner),
                           c = vertices.at(t, i, j + 1, inner);
        mesh_.triangles.push_back({a, b, c});
        if (i + j + 2 <= n) mesh_.triangles.push_back({b, vertices.at(t, i + 1, j + 1, inner), c});
      }
  }
}

// In the order in which the constructor makes them: of row i there are 2 (n - i) - 1.
SurfacePoint FineMesh::fine(const SurfacePoint& point) const {
  if (per_side_ == 1) return point;
  const int n = per_side_;
  const double u = std::clamp(point.u, 0.0, 1.0) * n, v = std::clamp(point.v, 0.0, 1.0) * n;
  int i = std::min(int(u), n - 1), j = std::min(int(v), n - 1 - i);
  double du = u - i, dv = v - j;
  // Rounding may put a point beyond the long side.
  const bool beyond = du + dv > 1 && i + j + 2 <= n;
  const int before = i * (2 * n - i);
  const int number = before + 2 * j + (beyond ? 1 : 0);
  const int first = point.triangle * n * n;
  // The turned triangle's corners: (1, 0), (1, 1), (0, 1).
  if (beyond) return {first + number, du + dv - 1, 1 - du};
  return {first + number, du, dv};
}

PolarMap polar_map(const TriangleMesh& mesh, const SurfacePoint& centre, const Vec3& right,
                   const Vec3& up, double farthest_mm) {
  // Off the triangle's edges, where the first corners would have no direction.
  constexpr double kInside = 1e-4;
  SurfacePoint inside = centre;
  inside.u = (1 - 3 * kInside) * centre.u + kInside;
  inside.v = (1 - 3 * kInside) * centre.v + kInside;
  const Vec3 start = position_at(mesh, inside), exact = position_at(mesh, centre);
  const Vec2 shift((start - exact).dot(right), (start - exact).dot(up));
  Spreading spreading(mesh, kBeyond * farthest_mm);
  for (const std::int32_t v : mesh.triangles[std::size_t(centre.triangle)]) {
    const Vec3 d = mesh.positions[std::size_t(v)] - start;
    spreading.start(v, {d.norm(), std::atan2(d.dot(up), d.dot(right))});
  }
  spreading.run();
  PolarMap map;
  map.place_mm.reserve(mesh.positions.size());
  for (const Polar& p : spreading.polar())
    map.place_mm.push_back(p.distance < kFar
                               ? Vec2(p.distance * Vec2(std::cos(p.angle), std::sin(p.angle)))
                               : Vec2(kFar, kFar));
  constexpr int kRounds = 10;
  Evening(mesh, map.place_mm).run(kRounds);
  for (Vec2& place : map.place_mm) place += shift;
  return map;
}

}  // namespace hydrodip
