#include "rig/solids.h"

#include <algorithm>
#include <array>
#include <map>

namespace hydrodip {
namespace {

using Cell = std::array<int, 3>;

// Vertices by number of a lattice, made as they are first needed.
class Builder {
 public:
  std::int32_t vertex(const Cell& at, const Vec3& position) {
    const auto [known, is_new] = number_.emplace(at, std::int32_t(mesh_.positions.size()));
    if (is_new) mesh_.positions.push_back(position);
    return known->second;
  }
  // Counter-clockwise, seen from outside.
  void quad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.triangles.push_back({a, c, d});
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  std::map<Cell, std::int32_t> number_;
  TriangleMesh mesh_;
};

}  // namespace

bool BoxSolid::holds(const Vec3& point) const {
  bool in = false;
  for (const Step& step : steps_) {
    const bool inside =
        (point.array() > step.min.array()).all() && (point.array() < step.max.array()).all();
    if (step.kind == Kind::kAdd) in = in || inside;
    if (step.kind == Kind::kCut) in = in && !inside;
    if (step.kind == Kind::kKeep) in = in && inside;
  }
  return in;
}

TriangleMesh BoxSolid::mesh() const {
  std::array<std::vector<double>, 3> line;
  for (const Step& step : steps_)
    for (std::size_t k = 0; k < 3; ++k) {
      line[k].push_back(step.min[Eigen::Index(k)]);
      line[k].push_back(step.max[Eigen::Index(k)]);
    }
  for (auto& l : line) {
    std::sort(l.begin(), l.end());
    l.erase(std::unique(l.begin(), l.end()), l.end());
  }
  const auto count = [&](std::size_t k) { return int(line[k].size()) - 1; };
  const auto full = [&](const Cell& cell) {
    Vec3 middle;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell[k] < 0 || cell[k] >= count(k)) return false;
      middle[Eigen::Index(k)] =
          0.5 * (line[k][std::size_t(cell[k])] + line[k][std::size_t(cell[k]) + 1]);
    }
    return holds(middle);
  };
  Builder builder;
  const auto vertex = [&](const Cell& at) {
    return builder.vertex(at, {line[0][std::size_t(at[0])], line[1][std::size_t(at[1])],
                               line[2][std::size_t(at[2])]});
  };
  for (int i = 0; i < count(0); ++i)
    for (int j = 0; j < count(1); ++j)
      for (int k = 0; k < count(2); ++k) {
        if (!full({i, j, k})) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            Cell beside = {i, j, k};
            beside[axis] += side == 1 ? 1 : -1;
            if (full(beside)) continue;
            const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
            std::array<Cell, 4> corner;
            corner.fill({i, j, k});
            for (Cell& c : corner) c[axis] += side;
            ++corner[1][a], ++corner[2][a], ++corner[2][b], ++corner[3][b];
            if (side == 0) std::swap(corner[1], corner[3]);
            builder.quad(vertex(corner[0]), vertex(corner[1]), vertex(corner[2]),
                         vertex(corner[3]));
          }
      }
  return builder.take();
}

TriangleMesh HeightSolid::mesh() const {
  const int nx = int(x.size()) - 1, ny = int(y.size()) - 1;
  std::vector<std::uint8_t> there(std::size_t(nx) * std::size_t(ny));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      there[std::size_t(j) * std::size_t(nx) + std::size_t(i)] =
          is_there(0.5 * Vec2(x[std::size_t(i)] + x[std::size_t(i) + 1],
                              y[std::size_t(j)] + y[std::size_t(j) + 1]));
  const auto full = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny &&
           there[std::size_t(j) * std::size_t(nx) + std::size_t(i)] != 0;
  };
  Builder builder;
  const auto vertex = [&](int i, int j, int top) {
    const auto a = std::size_t(i), b = std::size_t(j);
    return builder.vertex({i, j, top}, {x[a], y[b], top ? high(a, b) : low(a, b)});
  };
  // A wall below the edge from one crossing to the next, outside on its right.
  const auto wall = [&](int i, int j, int k, int l) {
    builder.quad(vertex(i, j, 0), vertex(k, l, 0), vertex(k, l, 1), vertex(i, j, 1));
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      if (!full(i, j)) continue;
      builder.quad(vertex(i, j, 1), vertex(i + 1, j, 1), vertex(i + 1, j + 1, 1),
                   vertex(i, j + 1, 1));
      builder.quad(vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0),
                   vertex(i + 1, j, 0));
      if (!full(i, j - 1)) wall(i, j, i + 1, j);
      if (!full(i + 1, j)) wall(i + 1, j, i + 1, j + 1);
      if (!full(i, j + 1)) wall(i + 1, j + 1, i, j + 1);
      if (!full(i - 1, j)) wall(i, j + 1, i, j);
    }
  return builder.take();
}

}  // namespace hydrodip
