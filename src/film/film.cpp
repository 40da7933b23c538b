#include "film/film.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/run_scope.h"

namespace hydrodip {

namespace {

Vec2 free_extent(const FilmOptions& options) {
  if (!(options.grading >= 1 && options.grading <= 20))
    throw InputError("film.grading must lie between 1 and 20");
  Vec2 free(options.width_mm - 2 * options.margin_mm, options.height_mm - 2 * options.margin_mm);
  if (options.shape == FilmShape::kDisc) free.setConstant(free.minCoeff());
  if (!(free.minCoeff() > 0))
    throw InputError(fmt::format(
        "a margin of {:g} mm leaves no free film on a sheet of {:g} x {:g} mm; set film.margin_mm "
        "below {:g}",
        options.margin_mm, options.width_mm, options.height_mm,
        0.5 * std::min(options.width_mm, options.height_mm)));
  return free;
}

int nearest_even(double value) { return std::max(2, 2 * static_cast<int>(std::lround(value / 2))); }

// Lines from -half to half; the distance between them grows with the square of their number.
// Built outwards from 0, so that mirrored lines are exact mirror images.
std::vector<double> grid_lines(double half, std::size_t cells, double grading) {
  std::vector<double> lines(2 * cells + 1, 0.0);
  const double bend = (grading - 1) / 3;
  for (std::size_t i = 1; i <= cells; ++i) {
    const double xi = double(i) / double(cells);
    const double x = i == cells ? half : half * (xi + bend * xi * xi * xi) / (1 + bend);
    lines[cells + i] = x;
    lines[cells - i] = -x;
  }
  return lines;
}

// Even cell counts put a vertex at the centre, so that the alternating diagonals are symmetric.
void choose_grid(const FilmOptions& options, const Vec2& free, double cells, FilmMesh& mesh) {
  const int cells_x = nearest_even(std::sqrt(cells * free.x() / free.y()));
  const int cells_y = free.x() == free.y() ? cells_x : nearest_even(cells / cells_x);
  mesh.nx = cells_x + 1;
  mesh.ny = cells_y + 1;
  mesh.cell_mm = std::max(free.x() / cells_x, free.y() / cells_y);
  mesh.line_x = grid_lines(free.x() / 2, std::size_t(cells_x) / 2, options.grading);
  mesh.line_y = grid_lines(free.y() / 2, std::size_t(cells_y) / 2, options.grading);
}

// Grid vertices by number j * nx + i, before those outside a disc are left out.
struct Grid {
  std::vector<Vec2> u;
  std::vector<std::uint8_t> on_rim;
  std::vector<Triangle> triangles;
};

Grid rectangle_grid(const FilmMesh& mesh) {
  Grid grid;
  const int nx = mesh.nx, ny = mesh.ny;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      grid.u.emplace_back(mesh.line_x[std::size_t(i)], mesh.line_y[std::size_t(j)]);
      grid.on_rim.push_back(i == 0 || j == 0 || i == nx - 1 || j == ny - 1);
    }
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const std::int32_t a = j * nx + i, b = a + 1, c = a + nx + 1, d = a + nx;
      const bool rising = (i - (nx - 1) / 2 + j - (ny - 1) / 2) % 2 == 0;
      if (rising) {
        grid.triangles.push_back({a, b, c});
        grid.triangles.push_back({a, c, d});
      } else {
        grid.triangles.push_back({a, b, d});
        grid.triangles.push_back({b, c, d});
      }
    }
  return grid;
}

// Moves the vertices next to the circle onto it and drops what lies outside. "Next to": nearer than
// a third of the shortest edge that leaves the vertex towards it.
void cut_disc(Grid& grid, double radius, const FilmMesh& mesh) {
  const auto gap = [](const std::vector<double>& lines, std::size_t i) {
    return std::min(i > 0 ? lines[i] - lines[i - 1] : 1e300,
                    i + 1 < lines.size() ? lines[i + 1] - lines[i] : 1e300);
  };
  std::vector<std::uint8_t> inside(grid.u.size());
  for (std::size_t v = 0; v < grid.u.size(); ++v) {
    const std::size_t nx = mesh.line_x.size();
    const Vec2 cell(gap(mesh.line_x, v % nx), gap(mesh.line_y, v / nx));
    const double r = grid.u[v].norm();
    // Towards the circle the grid is as wide as its cell along that direction.
    const double width = r > 0 ? 1 / (grid.u[v].cwiseAbs() / r).cwiseQuotient(cell).maxCoeff() : 0;
    inside[v] = r < radius - 0.35 * std::min(width, cell.maxCoeff());
  }
  std::vector<Triangle> kept;
  for (const Triangle& t : grid.triangles)
    if (inside[std::size_t(t[0])] || inside[std::size_t(t[1])] || inside[std::size_t(t[2])])
      kept.push_back(t);
  grid.triangles = std::move(kept);
  for (std::size_t v = 0; v < grid.u.size(); ++v) {
    grid.on_rim[v] = !inside[v];
    if (!inside[v]) grid.u[v] *= radius / grid.u[v].norm();
  }
}

Grid make_grid(const FilmOptions& options, const Vec2& free, double cells, FilmMesh& mesh) {
  check_cancelled();
  choose_grid(options, free, cells, mesh);
  Grid grid = rectangle_grid(mesh);
  if (options.shape == FilmShape::kDisc) cut_disc(grid, free.x() / 2, mesh);
  return grid;
}

void number_vertices(Grid& grid, FilmMesh& mesh) {
  std::vector<std::uint8_t> used(grid.u.size(), 0);
  for (const Triangle& t : grid.triangles)
    for (std::int32_t v : t) used[std::size_t(v)] = 1;
  mesh.vertex_at.assign(grid.u.size(), -1);
  for (std::size_t v = 0; v < grid.u.size(); ++v) {
    if (!used[v]) continue;
    mesh.vertex_at[v] = static_cast<std::int32_t>(mesh.u.size());
    mesh.u.push_back(grid.u[v]);
    mesh.on_rim.push_back(grid.on_rim[v]);
  }
  mesh.first_in_cell.assign(std::size_t(mesh.nx - 1) * std::size_t(mesh.ny - 1), -1);
  for (Triangle t : grid.triangles) {
    const std::int32_t i = std::min({t[0] % mesh.nx, t[1] % mesh.nx, t[2] % mesh.nx});
    const std::int32_t j = std::min({t[0] / mesh.nx, t[1] / mesh.nx, t[2] / mesh.nx});
    std::int32_t& first = mesh.first_in_cell[std::size_t(j * (mesh.nx - 1) + i)];
    if (first < 0) first = static_cast<std::int32_t>(mesh.triangles.size());
    for (std::int32_t& v : t) v = mesh.vertex_at[std::size_t(v)];
    mesh.triangles.push_back(t);
  }
}

void list_incident_triangles(FilmMesh& mesh) {
  mesh.incident_begin.assign(mesh.u.size() + 1, 0);
  for (const Triangle& t : mesh.triangles)
    for (std::int32_t v : t) ++mesh.incident_begin[std::size_t(v) + 1];
  for (std::size_t v = 0; v < mesh.u.size(); ++v)
    mesh.incident_begin[v + 1] += mesh.incident_begin[v];
  mesh.incident.resize(3 * mesh.triangles.size());
  std::vector<std::int32_t> next(mesh.incident_begin.begin(), mesh.incident_begin.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::int32_t v : mesh.triangles[t])
      mesh.incident[std::size_t(next[std::size_t(v)]++)] = static_cast<std::int32_t>(t);
}

void find_neighbors(FilmMesh& mesh) {
  mesh.neighbor.assign(mesh.triangles.size(), {-1, -1, -1});
  const auto find_of = [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangles[t][(k + 1) % 3], b = mesh.triangles[t][(k + 2) % 3];
      for (std::int32_t n = mesh.incident_begin[std::size_t(a)];
           n < mesh.incident_begin[std::size_t(a) + 1]; ++n) {
        const std::int32_t other = mesh.incident[std::size_t(n)];
        const Triangle& o = mesh.triangles[std::size_t(other)];
        if (other != static_cast<std::int32_t>(t) && (o[0] == b || o[1] == b || o[2] == b))
          mesh.neighbor[t][k] = other;
      }
    }
  };
  parallel_for(mesh.triangles.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) find_of(t);
  });
}

// The grid as it lies so far is the film model's.
void tell_printed_from_wet(const FilmOptions& options, FilmMesh& mesh) {
  const bool swells = options.swelling_x != 1 || options.swelling_y != 1;
  if (!swells && !options.correction) return;
  const Vec2 swelling(options.swelling_x, options.swelling_y);
  for (const Vec2& u : mesh.u) mesh.wet.push_back(u.cwiseProduct(swelling));
  if (!options.correction) return;
  for (Vec2& u : mesh.u) u += options.correction->at(u);
  for (const Triangle& t : mesh.triangles) {
    const Vec2& a = mesh.u[std::size_t(t[0])];
    if (!(cross2(mesh.u[std::size_t(t[1])] - a, mesh.u[std::size_t(t[2])] - a) > 0))
      throw InputError(
          "film.correction moves neighbouring places past each other; measure the dip anew, or "
          "correct it by fewer scans");
  }
}

// Fine film takes its time: each part looks whether it is still wanted.
void finish(const FilmOptions& options, Grid& grid, FilmMesh& mesh) {
  check_cancelled();
  number_vertices(grid, mesh);
  check_cancelled();
  mesh.options = options;
  if (mesh.triangles.size() < 8)
    throw InputError("the film needs at least 8 triangles; set film.elements higher");
  tell_printed_from_wet(options, mesh);
  list_incident_triangles(mesh);
  find_neighbors(mesh);
}

// From rim to rim, with as many cells on either side of 0.
void require_grid(const std::vector<double>& lines, double half) {
  bool good =
      lines.size() % 2 == 1 && lines.size() > 2 && lines.front() == -half && lines.back() == half;
  for (std::size_t i = 0; good && i + 1 < lines.size(); ++i) good = lines[i] < lines[i + 1];
  if (!good)
    throw InputError("a film's grid lines must ascend from rim to rim, evenly to both sides");
}

}  // namespace

Vec2 half_of_free_film(const FilmOptions& options) { return free_extent(options) / 2; }

bool is_free(const FilmOptions& options, const Vec2& u) {
  const Vec2 half = 0.5 * Vec2(options.width_mm, options.height_mm);
  const double margin = options.margin_mm;
  if (options.shape == FilmShape::kDisc) return u.norm() < half.minCoeff() - margin;
  return std::abs(u.x()) < half.x() - margin && std::abs(u.y()) < half.y() - margin;
}

FilmMesh make_film_mesh(const FilmOptions& options) {
  const Vec2 free = free_extent(options);
  FilmMesh mesh;
  double cells = 0.5 * options.elements;
  Grid grid = make_grid(options, free, cells, mesh);
  if (options.shape == FilmShape::kDisc && !grid.triangles.empty()) {
    // How much of a graded grid falls outside the disc is seen only once it is cut.
    cells *= options.elements / double(grid.triangles.size());
    grid = make_grid(options, free, cells, mesh);
  }
  finish(options, grid, mesh);
  return mesh;
}

FilmMesh make_film_mesh(const FilmOptions& options, const GridLines& lines) {
  const Vec2 free = free_extent(options);
  require_grid(lines.x, free.x() / 2);
  require_grid(lines.y, free.y() / 2);
  FilmMesh mesh;
  mesh.line_x = lines.x;
  mesh.line_y = lines.y;
  mesh.nx = int(lines.x.size());
  mesh.ny = int(lines.y.size());
  mesh.cell_mm = std::max(free.x() / (mesh.nx - 1), free.y() / (mesh.ny - 1));
  Grid grid = rectangle_grid(mesh);
  if (options.shape == FilmShape::kDisc) cut_disc(grid, 0.5 * free.x(), mesh);
  finish(options, grid, mesh);
  return mesh;
}

FilmMesh floating_mesh(const FilmMesh& mesh) {
  FilmMesh floating = mesh;
  floating.u = mesh.wet;
  floating.wet.clear();
  FilmOptions& options = floating.options;
  const double x = options.swelling_x, y = options.swelling_y;
  for (double& line : floating.line_x) line *= x;
  for (double& line : floating.line_y) line *= y;
  floating.cell_mm *= std::max(x, y);
  options.width_mm *= x;
  options.height_mm *= y;
  options.swelling_x = options.swelling_y = 1;
  options.correction = nullptr;
  return floating;
}

bool DippedFilm::lies_on_object(std::size_t triangle) const {
  if (!torn.empty() && torn[triangle]) return false;
  for (std::int32_t v : shared_mesh->triangles[triangle])
    if (state[std::size_t(v)] != VertexState::kAttached) return false;
  return true;
}

double DippedFilm::excess_at(std::size_t triangle, const Vec3& weight) const {
  if (excess.empty()) return 0;
  const Triangle& v = shared_mesh->triangles[triangle];
  return weight[0] * excess[std::size_t(v[0])] + weight[1] * excess[std::size_t(v[1])] +
         weight[2] * excess[std::size_t(v[2])];
}

DippedFilm::Part DippedFilm::whole_part(std::size_t triangle) const {
  Part part;
  if (!lies_on_object(triangle)) return part;
  const std::array<Vec3, 3> corner = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const auto add = [&](const Vec3& weight, std::size_t side) {
    part.corner[part.corners] = weight;
    part.side[part.corners++] = std::uint8_t(side);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, side = (k + 2) % 3;
    const double here = excess_at(triangle, corner[k]), there = excess_at(triangle, corner[l]);
    if (!(here > 0)) add(corner[k], side);
    if ((here > 0) == (there > 0)) continue;
    // In the same place from both triangles of the side.
    const Vec3 cut = (there * corner[k] - here * corner[l]) / (there - here);
    add(cut, here > 0 ? side : 3);
  }
  // A fan from its first corner.
  for (std::size_t k = 2; k < part.corners; ++k) {
    Mat3 fan;
    fan << part.corner[0], part.corner[k - 1], part.corner[k];
    part.share += fan.determinant();
  }
  return part;
}

}  // namespace hydrodip
