#include "object/edges.h"

#include <algorithm>
#include <functional>

namespace hydrodip {

bool runs_up(const TriangleMesh& mesh, const TriangleSide& side) {
  return mesh.triangles[side.place / 3][side.place % 3] == side.low_vertex();
}

std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh) {
  std::vector<TriangleSide> sides(3 * mesh.triangles.size());
  for (std::size_t place = 0; place < sides.size(); ++place) {
    const Triangle& t = mesh.triangles[place / 3];
    const auto a = std::uint64_t(t[place % 3]), b = std::uint64_t(t[(place + 1) % 3]);
    sides[place] = {std::min(a, b) << 32 | std::max(a, b), std::uint32_t(place)};
  }
  sort_unless_cancelled(sides.begin(), sides.end(), std::less<>());
  return sides;
}

}  // namespace hydrodip
