// Which triangles meet at which edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/run_scope.h"
#include "object/object.h"

namespace hydrodip {

// Turns of a loop over triangles between two looks whether the job was cancelled.
inline constexpr int kTrianglesBetweenChecks = 1 << 14;

// One side of a triangle. Sorting brings those on the same edge together.
struct TriangleSide {
  std::uint64_t edge;   // smaller vertex in the high half, larger in the low half
  std::uint32_t place;  // 3 * triangle + corner
  bool operator<(const TriangleSide& other) const {
    return edge != other.edge ? edge < other.edge : place < other.place;
  }
  std::int32_t low_vertex() const { return std::int32_t(edge >> 32); }
  std::int32_t high_vertex() const { return std::int32_t(edge & 0xffffffffu); }
};

inline std::int32_t face_of(const TriangleSide& side) { return std::int32_t(side.place / 3); }

// Whether the triangle runs from the edge's smaller to its larger vertex.
bool runs_up(const TriangleMesh& mesh, const TriangleSide& side);

// All sides of all triangles, in edge order. Throws Cancelled.
std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh);

// Calls visit(begin, end) for the sides of every edge, in edge order. Throws Cancelled.
template <typename Visit>
void for_each_edge(const std::vector<TriangleSide>& sides, Visit visit) {
  CheckEvery check(1 << 14);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    check();
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    visit(begin, end);
  }
}

}  // namespace hydrodip
