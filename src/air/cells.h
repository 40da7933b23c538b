// The space around an object, cut into cells, and where the surface stands between two of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// Cubes over the object's bounds and one beyond them on every side; the border stands for all that
// is further out. Two that share a face are
// linked unless the surface crosses the way between their centres, which is decided exactly: no
// wall is too thin to part them. A passage that is narrower than a cell may have no way through it.
class AirCells {
 public:
  // Throws Cancelled.
  AirCells(const TriangleMesh& mesh, std::size_t most_cells)
      : AirCells(mesh, mesh.bounds(), most_cells) {}
  // Over a part of it.
  AirCells(const TriangleMesh& mesh, const Box3& part, std::size_t most_cells);

  double pitch_mm() const { return pitch_; }
  std::size_t count() const { return std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]); }
  Vec3 center(std::size_t cell) const;
  // The cell whose centre is nearest; a point outside belongs to the outermost one.
  std::size_t cell_of(const Vec3& point) const;
  bool on_border(std::size_t cell) const;

  // Calls visit(other) for all linked cells.
  template <typename Visit>
  void for_linked(std::size_t cell, const Visit& visit) const;

  // A way between two cells that is too narrow to be seen.
  void add_link(std::size_t a, std::size_t b);

 private:
  void block(const TriangleMesh& mesh, int axis);

  double pitch_ = 1;
  Vec3 first_ = Vec3::Zero();  // centre of cell 0
  std::array<int, 3> n_{};
  std::array<std::size_t, 3> stride_{};
  // Per axis and cell: the surface stands before the next cell.
  std::array<std::vector<std::uint8_t>, 3> blocked_;
  std::vector<std::pair<std::size_t, std::size_t>> extra_;  // both ways, sorted
  std::vector<std::uint8_t> has_extra_;
};

template <typename Visit>
void AirCells::for_linked(std::size_t cell, const Visit& visit) const {
  std::size_t rest = cell;
  for (int axis = 2; axis >= 0; --axis) {
    const std::size_t stride = stride_[std::size_t(axis)];
    const std::size_t i = rest / stride;
    rest %= stride;
    const auto& blocked = blocked_[std::size_t(axis)];
    if (i > 0 && !blocked[cell - stride]) visit(cell - stride);
    if (i + 1 < std::size_t(n_[std::size_t(axis)]) && !blocked[cell]) visit(cell + stride);
  }
  if (has_extra_.empty() || !has_extra_[cell]) return;
  auto link = std::lower_bound(extra_.begin(), extra_.end(), std::pair(cell, std::size_t(0)));
  for (; link != extra_.end() && link->first == cell; ++link) visit(link->second);
}

}  // namespace hydrodip
