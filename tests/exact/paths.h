// Paths through film whose result is known, for tests and benchmarks.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "exact/dipping.h"

namespace hydrodip::exact {

// A strip of film, clamped at x = +-half_width and free along its other two edges.
inline FilmMesh strip(double half_width, int elements, double grading = 4) {
  FilmMesh mesh = make_film_mesh({.width_mm = 2 * half_width + 20,
                                  .height_mm = 120,
                                  .margin_mm = 10,
                                  .elements = elements,
                                  .grading = grading});
  for (std::size_t v = 0; v < mesh.u.size(); ++v)
    mesh.on_rim[v] = std::abs(std::abs(mesh.u[v].x()) - half_width) < 1e-9;
  return mesh;
}

inline DipResult dip_along(const shapes::Shape& shape, const FilmMesh& film,
                           const Trajectory& trajectory, const DipOptions& options) {
  const Surface surface(shape.positions, shape.triangles);
  RunContext context;
  return dip(film, shape.positions, shape.triangles, surface, trajectory, options, context);
}

// Largest and root mean square distance from the exact film coordinate, over what has attached.
struct PathError {
  double largest_mm = 0, root_mean_square_mm = 0, sideways_mm = 0;
  double reach_mm = 0;  // furthest from the first touch
  int vertices = 0;
  DipStatistics statistics;

  void add(const Vec2& error, double distance) {
    largest_mm = std::max(largest_mm, error.norm());
    root_mean_square_mm += error.squaredNorm();
    reach_mm = std::max(reach_mm, distance);
    ++vertices;
  }
  void finish() { root_mean_square_mm = std::sqrt(root_mean_square_mm / std::max(1, vertices)); }
};

inline Trajectory path_of(const RolledCylinder& cylinder) {
  return Trajectory::through({{},
                              {.lower_mm = cylinder.lower,
                               .shift_x_mm = cylinder.shift,
                               .turn_y_deg = cylinder.turn / kDegree}});
}

inline DipResult dip_cylinder(const RolledCylinder& cylinder, const FilmMesh& film,
                              double step_mm) {
  const shapes::Shape shape = shapes::trough(cylinder.radius, 70, 100 * kDegree, 1440);
  DipOptions options;
  options.step_mm = step_mm;
  options.material.tear_stretch = 0;
  options.material.z_stretch = cylinder.z_stretch;
  return dip_along(shape, film, path_of(cylinder), options);
}

inline PathError rolled_cylinder_error(const RolledCylinder& cylinder, int elements,
                                       double step_mm = 0.1) {
  const FilmMesh film = strip(cylinder.L, elements);
  const DipResult result = dip_cylinder(cylinder, film, step_mm);
  const RolledCylinder::Side right = cylinder.solved(1), left = cylinder.solved(-1);
  PathError error;
  error.statistics = result.statistics;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    if (result.film.state[v] != VertexState::kAttached) continue;
    const Vec3& p = result.film.position[v];
    const double psi = std::atan2(p.x(), cylinder.radius - p.z());
    const double exact_u = psi > 0 ? right.at(psi) : left.at(psi);
    error.add(Vec2(film.u[v].x() - exact_u, film.u[v].y() - p.y()),
              cylinder.radius * std::abs(psi));
  }
  error.finish();
  return error;
}

// A sphere that turns about the vertical by so much while its water line goes out to 28 mm,
// evenly with the radius.
inline PathError twisted_sphere_error(double turn_deg, int elements, double step_mm = 0.1) {
  constexpr double R = 30, kTo = 28, kEnd = 28.4;
  const auto tan_theta = [](double a) { return a / std::sqrt(R * R - a * a); };
  const auto height = [](double a) { return R - std::sqrt(R * R - a * a); };
  std::vector<Keyframe> keyframes;
  constexpr int kPieces = 400;
  for (int n = 0; n <= kPieces; ++n) {
    const double a = kEnd * n / kPieces;
    keyframes.push_back({.lower_mm = height(a), .turn_z_deg = turn_deg * a / kTo});
  }
  const FilmMesh film = disc_film(elements);
  DipOptions options;
  options.step_mm = step_mm;
  options.material.tear_stretch = 0;
  const DipResult result =
      dip_along(shapes::sphere_bowl(R, 29.5), film, Trajectory::through(keyframes), options);
  const RevolutionTable u(kEnd, options.material.z_stretch, tan_theta);
  std::vector<double> radii;
  for (double a = 0.05; a <= kEnd; a += 0.05) radii.push_back(a);
  const auto phi = [&](double a) { return turn_deg * kDegree * a / kTo; };
  const std::vector<double> v_of =
      twisted(radii, kClampRadius, options.material.z_stretch, tan_theta, u, phi);
  PathError error;
  error.statistics = result.statistics;
  for (std::size_t w = 0; w < film.u.size(); ++w) {
    if (result.film.state[w] != VertexState::kAttached) continue;
    const Vec2 p = result.film.position[w].head<2>();
    const double a = p.norm();
    if (a < 3 || a > kTo) continue;
    const auto n = std::size_t(a / 0.05) - 1;
    const double s = (a - radii[n]) / 0.05, v = v_of[n] + s * (v_of[n + 1] - v_of[n]);
    const double angle = std::atan2(p.y(), p.x()) + phi(a);
    const Vec2 out(std::cos(angle), std::sin(angle)), along(-out.y(), out.x());
    error.add(film.u[w] - u(a) * out - v * along, a);
  }
  error.finish();
  return error;
}

}  // namespace hydrodip::exact
