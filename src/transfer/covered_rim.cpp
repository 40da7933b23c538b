#include "transfer/covered_rim.h"

#include <algorithm>
#include <array>

namespace hydrodip {

CoveredRim::CoveredRim(const DippedFilm& film) {
  const FilmMesh& mesh = film.mesh();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Triangle& v = mesh.triangles[t];
    const DippedFilm::Part part = film.whole_part(t);
    std::array<Vec2, 4> corner;
    Vec2 centroid = Vec2::Zero();
    for (std::size_t k = 0; k < part.corners; ++k) {
      corner[k] = part.corner[k][0] * mesh.u[std::size_t(v[0])] +
                  part.corner[k][1] * mesh.u[std::size_t(v[1])] +
                  part.corner[k][2] * mesh.u[std::size_t(v[2])];
      covered_.add(corner[k]);
      centroid += corner[k] / double(part.corners);
    }
    for (std::size_t n = 1; n <= part.corners; ++n) {
      const std::size_t k = n % part.corners;
      const std::int32_t other = part.side[k] < 3 ? mesh.neighbor[t][part.side[k]] : -1;
      if (other >= 0 && film.lies_on_object(std::size_t(other))) continue;
      const Vec2 &a = corner[k], &b = corner[(k + 1) % part.corners];
      if (a == b) continue;
      edges_.push_back({a, b, centroid});
      bounds_.add(a);
      bounds_.add(b);
    }
  }
  if (edges_.empty()) return;
  cells_ = Cells(bounds_, film.mesh().cell_mm);
  edges_in_.resize(cells_.count());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const CellRange cells = cells_.around(edge.a.cwiseMin(edge.b), edge.a.cwiseMax(edge.b));
    for (int y = cells.y0; y <= cells.y1; ++y)
      for (int x = cells.x0; x <= cells.x1; ++x)
        edges_in_[cells_.number(x, y)].push_back(std::int32_t(e));
  }
}

std::optional<Vec2> CoveredRim::nearest(const Vec2& u, double max_distance) const {
  const Vec2 reach(max_distance, max_distance);
  const Vec2 min = u - reach, max = u + reach;
  if (edges_.empty() || (min - bounds_.max).maxCoeff() > 0 || (bounds_.min - max).maxCoeff() > 0)
    return std::nullopt;
  double best = max_distance * max_distance;
  std::optional<Vec2> found;
  const CellRange cells = cells_.around(min, max);
  for (int y = cells.y0; y <= cells.y1; ++y)
    for (int x = cells.x0; x <= cells.x1; ++x)
      for (const std::int32_t e : edges_in_[cells_.number(x, y)]) {
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
