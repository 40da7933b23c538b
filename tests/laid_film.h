// A ball with film laid on its lower half by vertical projection: enough for everything that shows
// a result, and known in closed form.
#pragma once

#include <cmath>
#include <numbers>

#include "film/film.h"
#include "object/object.h"

namespace hydrodip::fixtures {

constexpr double kRadius = 20;

// Unit-quad faces of a cube blown up to a ball of radius kRadius, lowest point at z = 0. Red where
// x < 0, blue elsewhere.
inline Object two_coloured_ball(int cells = 24) {
  Object ball;
  ball.materials.resize(2);
  ball.materials[0].base_color = {1, 0, 0, 1};
  ball.materials[1].base_color = {0, 0, 1, 1};
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1 : -1;
    const auto first = std::int32_t(ball.positions.size());
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        Vec3 p;
        p[axis] = sign;
        p[(axis + 1) % 3] = std::tan((2.0 * i / cells - 1) * std::numbers::pi / 4);
        p[(axis + 2) % 3] = std::tan((2.0 * j / cells - 1) * std::numbers::pi / 4);
        ball.positions.push_back(kRadius * p.normalized() + Vec3(0, 0, kRadius));
      }
    }
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        const std::int32_t a = first + j * (cells + 1) + i;
        const std::int32_t b = a + 1;
        const std::int32_t c = a + cells + 2;
        const std::int32_t d = a + cells + 1;
        for (Triangle t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
          if (sign < 0) std::swap(t[1], t[2]);
          double x = 0;
          for (const std::int32_t v : t) x += ball.positions[std::size_t(v)].x();
          ball.triangles.push_back(t);
          ball.material_of.push_back(x < 0 ? 0 : 1);
        }
      }
    }
  }
  return ball;
}

// Film that came down straight on the ball's underside, out to `reach_mm` from its axis.
inline DippedFilm film_under_ball(double reach_mm = 16) {
  FilmOptions options;
  options.width_mm = 80;
  options.height_mm = 100;
  options.elements = 3000;
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(make_film_mesh(options));
  for (std::size_t v = 0; v < film.mesh().u.size(); ++v) {
    const Vec2& u = film.mesh().u[v];
    const bool lies = u.norm() <= reach_mm;
    const double cosine = lies ? std::sqrt(1 - u.squaredNorm() / (kRadius * kRadius)) : 1;
    film.position.emplace_back(u.x(), u.y(), kRadius * (1 - cosine));
    film.state.push_back(film.mesh().on_rim[v] ? VertexState::kClamped
                         : lies                ? VertexState::kAttached
                                               : VertexState::kUnattached);
    film.area_ratio.push_back(1 / cosine);
    film.stretch.push_back(1 / cosine);
  }
  film.torn.assign(film.mesh().triangles.size(), 0);
  film.depth_mm = kRadius;
  return film;
}

}  // namespace hydrodip::fixtures
