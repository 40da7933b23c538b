// Dips for tests: a shape through a film, and how far the film lands from an exact solution.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "dip/dip.h"
#include "exact/shapes.h"
#include "exact/solutions.h"
#include "film/film.h"

namespace hydrodip::exact {

constexpr double kClampRadius = 100;  // of disc_film, mm
constexpr double kZStretch = 0.65;    // the default

// The clamped disc L = 100 mm of the exact solutions.
inline FilmMesh disc_film(int elements) {
  return make_film_mesh({.width_mm = 2 * kClampRadius + 20,
                         .height_mm = 2 * kClampRadius + 20,
                         .shape = FilmShape::kDisc,
                         .margin_mm = 10,
                         .elements = elements});
}

struct StraightDip : DipOptions {
  double depth_mm = 0;  // 0: the whole shape
};

// Exact solutions know no tears.
inline StraightDip untearing(double step_mm, double depth_mm) {
  StraightDip options;
  options.depth_mm = depth_mm;
  options.step_mm = step_mm;
  options.even_steps = true;
  options.material.tear_stretch = 0;
  return options;
}

inline DippedFilm dip_shape(const shapes::Shape& shape, const FilmMesh& film,
                            const StraightDip& options) {
  const Surface surface(shape.positions, shape.triangles);
  RunContext context;
  return dip(film, shape.positions, shape.triangles, surface,
             make_trajectory({options.depth_mm}, shape.positions), options, context)
      .film;
}

// exact::revolution for many radii: tabulated once, then interpolated (cubic, error below 1e-6 mm
// where the meridian keeps 1 mm away from a vertical wall).
class RevolutionTable {
 public:
  RevolutionTable(double a_max, double z_stretch, const std::function<double(double)>& tan_theta) {
    for (double a = kStep; a < a_max + 3 * kStep; a += kStep)
      u_.push_back(revolution(a, kClampRadius, z_stretch, tan_theta));
  }
  double operator()(double a) const {
    const int last = int(u_.size()) - 4;
    const int i = std::clamp(int(a / kStep) - 2, 0, last);
    const double t = a / kStep - 1 - i;  // 0 .. 3 between entries i .. i + 3
    const double* u = u_.data() + i;
    return -u[0] * (t - 1) * (t - 2) * (t - 3) / 6 + u[1] * t * (t - 2) * (t - 3) / 2 -
           u[2] * t * (t - 1) * (t - 3) / 2 + u[3] * t * (t - 1) * (t - 2) / 6;
  }

 private:
  static constexpr double kStep = 0.25;
  std::vector<double> u_;
};

// Film coordinate minus exact film coordinate, per attached vertex.
struct VertexError {
  std::int32_t vertex;
  double a;     // distance from the axis where it attached
  Vec2 radial;  // (along the radius, across it)
};

inline std::vector<VertexError> revolution_errors(const DippedFilm& film,
                                                  const RevolutionTable& exact, double a_min,
                                                  double a_max) {
  std::vector<VertexError> errors;
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    if (film.state[v] != VertexState::kAttached) continue;
    const Vec2 place = film.position[v].head<2>();
    const double a = place.norm();
    if (a < a_min || a > a_max) continue;
    const Vec2 out = place / a;
    const Vec2& u = film.mesh().u[v];
    errors.push_back({std::int32_t(v), a, Vec2(u.dot(out) - exact(a), cross2(out, u))});
  }
  return errors;
}

// Largest length of an error.
inline double largest(const std::vector<VertexError>& errors) {
  double result = 0;
  for (const VertexError& e : errors) result = std::max(result, e.radial.norm());
  return result;
}

inline double root_mean_square(const std::vector<VertexError>& errors) {
  double sum = 0;
  for (const VertexError& e : errors) sum += e.radial.squaredNorm();
  return std::sqrt(sum / double(errors.size()));
}

}  // namespace hydrodip::exact
