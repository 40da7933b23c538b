#include "export/film_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/color_difference.h"
#include "laid_film.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;
using fixtures::two_coloured_ball;

struct Dipped {
  Object ball = two_coloured_ball();
  Surface surface{ball.positions, ball.triangles};
  DippedFilm film = film_under_ball();
  FilmMap map{ball, surface, film};
  RunContext context;

  // The predicted colour is `off` on the right, right elsewhere.
  FilmLayer layer(const LinearColor& off) {
    Appearance shown;
    shown.wanted = [](const SurfacePoint&, const Vec3&, const Vec3&) {
      return LinearColor{0.5f, 0.5f, 0.5f, 1};
    };
    shown.predicted = [off](const SurfacePoint&, const Vec3& p, const Vec3&) {
      return p.x() > 0 ? off : LinearColor{0.5f, 0.5f, 0.5f, 1};
    };
    return color_error_layer(ball, map, shown, context);
  }
};

TEST(FilmLayer, ColorErrorIsWhereTheColoursDiffer) {
  Dipped dipped;
  const LinearColor off{0.2f, 0.5f, 0.5f, 1};
  const FilmLayer layer = dipped.layer(off);
  ASSERT_GT(layer.width, 100);
  const double expected = ciede2000(to_cielab({0.5f, 0.5f, 0.5f, 1}), to_cielab(off));
  EXPECT_GT(expected, 5);
  long there = 0;
  for (int y = 0; y < layer.height; ++y) {
    for (int x = 0; x < layer.width; ++x) {
      const float value = layer.values[std::size_t(y * layer.width + x)];
      const double size = layer.extent.max.x() - layer.extent.min.x();
      const double place = layer.extent.min.x() + (x + 0.5) * size / layer.width;
      if (std::isnan(value)) continue;
      ++there;
      if (std::abs(place) < 0.5) continue;  // cells across the border
      ASSERT_NEAR(double(value), place > 0 ? expected : 0, 1e-4);
    }
  }
  // A disc in its square.
  EXPECT_NEAR(double(there) / (layer.width * layer.height), std::numbers::pi / 4, 0.1);
  const LayerSummary summary = summarize(layer);
  EXPECT_NEAR(summary.mean, expected / 2, 0.03 * expected);
  EXPECT_NEAR(summary.most_of, expected, 1e-4);
}

TEST(FilmLayer, NothingCoveredIsNothing) {
  FilmLayer empty;
  EXPECT_EQ(summarize(empty).mean, 0);
}

// Film that lies flat, 10 % shorter along x and 20 % longer along y.
TEST(FilmLayer, FilmIsPressedByWhatItIsShorter) {
  FilmOptions options;
  options.width_mm = options.height_mm = 100;
  options.elements = 2000;
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(make_film_mesh(options));
  for (const Vec2& u : film.mesh().u) film.position.emplace_back(0.9 * u.x(), 1.2 * u.y(), 3);
  film.state.assign(film.mesh().u.size(), VertexState::kAttached);
  film.torn.assign(film.mesh().triangles.size(), 0);
  film.torn[0] = 1;
  const FilmLayer layer = pressed_layer(film, {Vec2(-30, -20), Vec2(30, 20)});
  for (const float value : layer.values) ASSERT_NEAR(double(value), 10, 1e-4);
}

}  // namespace
}  // namespace hydrodip
