#include "transfer/covered_rim.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {

CoveredRim::CoveredRim(const DippedFilm& film) : cell_(film.mesh.cell_mm) {
  const FilmMesh& mesh = film.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Triangle& v = mesh.triangles[t];
    Vec2 centroid = Vec2::Zero();
    for (std::int32_t k : v) {
      covered_.add(mesh.u[std::size_t(k)]);
      centroid += mesh.u[std::size_t(k)] / 3;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = mesh.neighbor[t][k];
      if (other >= 0 && film.lies_on_object(std::size_t(other))) continue;
      edges_.push_back(
          {mesh.u[std::size_t(v[(k + 1) % 3])], mesh.u[std::size_t(v[(k + 2) % 3])], centroid});
      bounds_.add(edges_.back().a);
      bounds_.add(edges_.back().b);
    }
  }
  if (edges_.empty()) return;
  const Vec2 size = bounds_.max - bounds_.min;
  nx_ = static_cast<int>(size.x() / cell_) + 1;
  ny_ = static_cast<int>(size.y() / cell_) + 1;
  buckets_.resize(std::size_t(nx_) * std::size_t(ny_));
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for_buckets(edges_[e].a.cwiseMin(edges_[e].b), edges_[e].a.cwiseMax(edges_[e].b),
                [&](std::size_t bucket) { buckets_[bucket].push_back(std::int32_t(e)); });
}

template <class Visit>
void CoveredRim::for_buckets(const Vec2& min, const Vec2& max, const Visit& visit) const {
  const auto bucket = [&](double distance, int buckets) {
    return static_cast<int>(std::clamp(std::floor(distance / cell_), 0.0, double(buckets - 1)));
  };
  const Vec2 from = min - bounds_.min, to = max - bounds_.min;
  const int x0 = bucket(from.x(), nx_), x1 = bucket(to.x(), nx_);
  const int y0 = bucket(from.y(), ny_), y1 = bucket(to.y(), ny_);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) visit(std::size_t(y) * std::size_t(nx_) + std::size_t(x));
}

std::optional<Vec2> CoveredRim::nearest(const Vec2& u, double max_distance) const {
  const Vec2 reach(max_distance, max_distance);
  const Vec2 min = u - reach, max = u + reach;
  if (edges_.empty() || (min - bounds_.max).maxCoeff() > 0 || (bounds_.min - max).maxCoeff() > 0)
    return std::nullopt;
  double best = max_distance * max_distance;
  std::optional<Vec2> found;
  for_buckets(min, max, [&](std::size_t bucket) {
    for (const std::int32_t e : buckets_[bucket]) {
      const Edge& edge = edges_[std::size_t(e)];
      const Vec2 along = edge.b - edge.a;
      const double at = std::clamp((u - edge.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const Vec2 point = edge.a + at * along;
      const double distance2 = (point - u).squaredNorm();
      if (distance2 >= best) continue;
      best = distance2;
      found = point + 1e-6 * (edge.inside - point);
    }
  });
  return found;
}

}  // namespace hydrodip
