#include "transfer/covered_rim.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {

CoveredRim::CoveredRim(const DippedFilm& film) : cell_(2 * film.mesh.cell_mm) {
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
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    // Edges are shorter than a bucket: its middle's bucket, searched one bucket wider, will do.
    const Vec2 middle = 0.5 * (edges_[e].a + edges_[e].b) - bounds_.min;
    const int x = std::clamp(static_cast<int>(middle.x() / cell_), 0, nx_ - 1);
    const int y = std::clamp(static_cast<int>(middle.y() / cell_), 0, ny_ - 1);
    buckets_[std::size_t(y) * std::size_t(nx_) + std::size_t(x)].push_back(
        static_cast<std::int32_t>(e));
  }
}

std::optional<Vec2> CoveredRim::nearest(const Vec2& u, double max_distance) const {
  if (edges_.empty()) return std::nullopt;
  const auto bucket = [&](double value, double origin) {
    return static_cast<int>(std::floor((value - origin) / cell_));
  };
  const int x0 = std::max(0, bucket(u.x() - max_distance, bounds_.min.x()) - 1);
  const int x1 = std::min(nx_ - 1, bucket(u.x() + max_distance, bounds_.min.x()) + 1);
  const int y0 = std::max(0, bucket(u.y() - max_distance, bounds_.min.y()) - 1);
  const int y1 = std::min(ny_ - 1, bucket(u.y() + max_distance, bounds_.min.y()) + 1);
  double best = max_distance * max_distance;
  std::optional<Vec2> found;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      for (std::int32_t e : buckets_[std::size_t(y) * std::size_t(nx_) + std::size_t(x)]) {
        const Edge& edge = edges_[std::size_t(e)];
        const Vec2 along = edge.b - edge.a;
        const double at = std::clamp((u - edge.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const Vec2 point = edge.a + at * along;
        const double distance2 = (point - u).squaredNorm();
        if (distance2 >= best) continue;
        best = distance2;
        found = point + 1e-6 * (edge.inside - point);
      }
  return found;
}

}  // namespace hydrodip
