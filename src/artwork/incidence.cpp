#include "artwork/incidence.h"

#include "base/filled.h"

namespace hydrodip {

Incidence::Incidence(const TriangleMesh& mesh)
    : begin_(filled<std::uint32_t>(mesh.positions.size() + 1, 0)),
      triangles_(filled<std::uint32_t>(3 * mesh.triangles.size(), 0)) {
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) ++begin_[std::size_t(v) + 1];
  for (std::size_t v = 0; v + 1 < begin_.size(); ++v) begin_[v + 1] += begin_[v];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::int32_t v : mesh.triangles[t])
      triangles_[next[std::size_t(v)]++] = std::uint32_t(t);
}

}  // namespace hydrodip
