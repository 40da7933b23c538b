#include "elastic/film_grid.h"

#include <algorithm>

#include "base/parallel.h"

namespace hydrodip {

namespace {

std::ptrdiff_t groups_for(int nodes) { return (nodes + kernels::kLanes - 1) / kernels::kLanes; }

// Grid column and row of every vertex.
std::vector<std::array<int, 2>> nodes_of(const FilmMesh& mesh) {
  std::vector<std::array<int, 2>> nodes(mesh.u.size());
  for (int j = 0; j < mesh.ny; ++j)
    for (int i = 0; i < mesh.nx; ++i) {
      const std::int32_t v = mesh.vertex_at[std::size_t(j) * std::size_t(mesh.nx) + std::size_t(i)];
      if (v >= 0) nodes[std::size_t(v)] = {i, j};
    }
  return nodes;
}

}  // namespace

GridLayout::GridLayout(int nodes_x, int nodes_y)
    : nx(nodes_x),
      ny(nodes_y),
      groups(groups_for(nodes_x)),
      stride((groups + 1) * kernels::kLanes) {}

FilmGrid::FilmGrid(const FilmMesh& mesh) : layout_(mesh.nx, mesh.ny), node_(nodes_of(mesh)) {
  for (const auto& [i, j] : node_) place_.push_back(static_cast<std::int32_t>(layout_.place(i, j)));
  place_triangles(mesh);
}

std::array<Vec2, 3> FilmGrid::corners(const Triangle& triangle, const GridField& field) const {
  std::array<Vec2, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t there = place(std::size_t(triangle[k]));
    at[k] = Vec2(field.x[there], field.y[there]);
  }
  return at;
}

void FilmGrid::place_triangles(const FilmMesh& mesh) {
  triangle_.assign(elements(), -1);
  for (auto& row : rising_) row = GridArray<double>(std::size_t(layout_.stride));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::array<int, 2>, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = node_[std::size_t(mesh.triangles[t][k])];
    const int i = std::min({corner[0][0], corner[1][0], corner[2][0]});
    const int j = std::min({corner[0][1], corner[1][1], corner[2][1]});
    const auto has = [&](int column, int row) {
      return std::find(corner.begin(), corner.end(), std::array<int, 2>{column, row});
    };
    const bool upper = has(i, j) == corner.end() || has(i + 1, j) == corner.end();
    const auto first = upper ? has(i + 1, j + 1) : has(i, j);
    const std::size_t place = layout_.place(i, j) + (upper ? layout_.entries() : 0);
    first_corner_.push_back(static_cast<std::uint8_t>(first - corner.begin()));
    element_.push_back(static_cast<std::int32_t>(place));
    triangle_[place] = static_cast<std::int32_t>(t);
    // Cut from (i, j) to (i + 1, j + 1): both triangles have both.
    if (has(i, j) == corner.end() || has(i + 1, j + 1) == corner.end()) continue;
    for (int column = i % 2; column < mesh.nx; column += 2)
      rising_[std::size_t(j % 2)][std::size_t(column)] = 1;
    for (int column = 1 - i % 2; column < mesh.nx; column += 2)
      rising_[std::size_t(1 - j % 2)][std::size_t(column)] = 1;
  }
}

void FilmGrid::to_grid(const VertexVector& from, GridField& to) const {
  parallel_for(from.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
    double *x = to.x.data(), *y = to.y.data();
    for (std::size_t v = begin; v < end; ++v) {
      x[place(v)] = from[v].x();
      y[place(v)] = from[v].y();
    }
  });
}

void FilmGrid::to_vertices(const GridField& from, VertexVector& to) const {
  to.resize(vertices());
  parallel_for(to.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
    const double *x = from.x.data(), *y = from.y.data();
    for (std::size_t v = begin; v < end; ++v) to[v] = Vec2(x[place(v)], y[place(v)]);
  });
}

GridField FilmGrid::field(const VertexVector& from) const {
  GridField to(layout_);
  to_grid(from, to);
  return to;
}

void FilmGrid::to_mask(const std::vector<std::uint8_t>& is_set, GridArray<double>& mask) const {
  parallel_for(is_set.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
    double* values = mask.data();
    for (std::size_t v = begin; v < end; ++v) values[place(v)] = is_set[v] ? 1 : 0;
  });
}

}  // namespace hydrodip
