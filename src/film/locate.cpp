#include "film/locate.h"

#include <algorithm>

namespace hydrodip {

namespace {

constexpr int kMaxWalk = 64;
constexpr double kInside = -1e-12;

bool weights_at(const FilmMesh& mesh, const std::vector<Vec2>& u, std::int32_t triangle,
                const Vec2& target, Vec3& weight) {
  const Triangle& t = mesh.triangles[std::size_t(triangle)];
  const Vec2 &a = u[std::size_t(t[0])], &b = u[std::size_t(t[1])], &c = u[std::size_t(t[2])];
  const double twice = cross2(b - a, c - a);
  if (!(twice > 0)) return false;
  weight[1] = cross2(target - a, c - a) / twice;
  weight[2] = cross2(b - a, target - a) / twice;
  weight[0] = 1 - weight[1] - weight[2];
  return true;
}

// In the two triangles of the grid's cell; on a disc, the rim's have been moved.
FilmLocation locate_in_cell(const FilmMesh& mesh, const Vec2& target) {
  const auto line_before = [](const std::vector<double>& lines, double x) {
    return std::upper_bound(lines.begin(), lines.end(), x) - lines.begin() - 1;
  };
  const auto i = line_before(mesh.line_x, target.x()), j = line_before(mesh.line_y, target.y());
  if (i < 0 || j < 0 || i >= mesh.nx - 1 || j >= mesh.ny - 1) return {};
  const std::int32_t first = mesh.first_in_cell[std::size_t(j * (mesh.nx - 1) + i)];
  if (first < 0) return {};
  for (std::int32_t t = first; t < first + 2 && t < std::int32_t(mesh.triangles.size()); ++t) {
    Vec3 weight;
    if (weights_at(mesh, mesh.u, t, target, weight) && weight.minCoeff() >= kInside)
      return {t, weight, true};
  }
  return {};
}

template <typename Usable>
FilmLocation walk(const FilmMesh& mesh, const std::vector<Vec2>& u, const Usable& usable,
                  std::int32_t start, const Vec2& target) {
  // Among the triangles around the vertex, the one that contains the target or comes nearest to it.
  FilmLocation best;
  double best_weight = -1e300;
  for (auto n = mesh.incident_begin[std::size_t(start)];
       n < mesh.incident_begin[std::size_t(start) + 1]; ++n) {
    const std::int32_t t = mesh.incident[std::size_t(n)];
    Vec3 weight;
    if (!usable(t) || !weights_at(mesh, u, t, target, weight)) continue;
    if (weight.minCoeff() > best_weight) {
      best_weight = weight.minCoeff();
      best = {t, weight, best_weight >= kInside};
    }
  }
  for (int walked = 0; best.triangle >= 0 && !best.inside && walked < kMaxWalk; ++walked) {
    int exit_corner = 0;
    best.weight.minCoeff(&exit_corner);
    const std::int32_t next = mesh.neighbor[std::size_t(best.triangle)][std::size_t(exit_corner)];
    Vec3 weight;
    if (next < 0 || !usable(next) || !weights_at(mesh, u, next, target, weight)) break;
    best = {next, weight, weight.minCoeff() >= kInside};
  }
  return best;
}

}  // namespace

FilmLocation locate(const FilmMesh& mesh, const std::vector<Vec2>& u,
                    const std::vector<std::uint8_t>& usable, std::int32_t start, const Vec2& target,
                    std::int32_t hint) {
  Vec3 weight;
  if (hint >= 0 && usable[std::size_t(hint)] && weights_at(mesh, u, hint, target, weight) &&
      weight.minCoeff() >= kInside)
    return {hint, weight, true};
  return walk(
      mesh, u, [&](std::int32_t t) { return usable[std::size_t(t)] != 0; }, start, target);
}

FilmLocation locate_flat(const FilmMesh& mesh, const Vec2& target) {
  if (!target.allFinite()) return {};
  if (FilmLocation found = locate_in_cell(mesh, target); found.inside) return found;
  const auto nearest_line = [](const std::vector<double>& lines, double x) {
    const auto above = std::lower_bound(lines.begin(), lines.end(), x);
    if (above == lines.begin()) return std::ptrdiff_t(0);
    if (above == lines.end()) return std::ptrdiff_t(lines.size()) - 1;
    return above - lines.begin() - (x - *(above - 1) < *above - x ? 1 : 0);
  };
  const auto i = nearest_line(mesh.line_x, target.x()), j = nearest_line(mesh.line_y, target.y());
  const std::int32_t start = mesh.vertex_at[std::size_t(j) * std::size_t(mesh.nx) + std::size_t(i)];
  if (start < 0) return {};
  return walk(
      mesh, mesh.u, [](std::int32_t) { return true; }, start, target);
}

}  // namespace hydrodip
