#include "coat/flat_film.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

// Film that lies, all of it, where `at` puts its points.
DippedFilm laid(const std::function<Vec3(const Vec2&)>& at) {
  FilmOptions options;
  options.width_mm = options.height_mm = 120;
  options.elements = 3000;
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(make_film_mesh(options));
  for (const Vec2& u : film.mesh().u) film.position.push_back(at(u));
  film.state.assign(film.mesh().u.size(), VertexState::kAttached);
  film.area_ratio.assign(film.mesh().u.size(), 1);
  film.stretch.assign(film.mesh().u.size(), 1);
  film.torn.assign(film.mesh().triangles.size(), 0);
  return film;
}

TEST(FlatFilm, OfFilmThatIsNotStretchedIsTheFilm) {
  constexpr double kRadius = 40;
  const FlatFilm flat(laid([](const Vec2& u) {
    return Vec3(kRadius * std::sin(u.x() / kRadius), u.y(), -kRadius * std::cos(u.x() / kRadius));
  }));
  for (const Vec2& u : {Vec2(0, 0), Vec2(20, -30), Vec2(-35, 5)})
    EXPECT_LT((flat.at(u) - u).norm(), 0.05);
  EXPECT_LT(flat.distortion(), 0.005);
  EXPECT_LT(flat.distortion_as_printed(), 0.005);
}

TEST(FlatFilm, TakesOutEvenStretch) {
  const FlatFilm flat(laid([](const Vec2& u) { return Vec3(1.3 * u.x(), 1.1 * u.y(), 0); }));
  EXPECT_NEAR(flat.distortion_as_printed(), std::sqrt((0.09 + 0.01) / 2), 0.01);
  EXPECT_LT(flat.distortion(), 1e-3);
  EXPECT_NEAR(flat.at({20, 10}).x() - flat.at({-20, 10}).x(), 52, 0.1);
  EXPECT_NEAR(flat.at({5, 20}).y() - flat.at({5, -20}).y(), 44, 0.1);
}

TEST(FlatFilm, LeavesLessOfAnUnevenStretch) {
  // A bulge stretches the middle: not all of it can be flat.
  const FlatFilm flat(laid(
      [](const Vec2& u) { return Vec3(u.x(), u.y(), 25 * std::exp(-u.squaredNorm() / 600)); }));
  EXPECT_LT(flat.distortion(), 0.8 * flat.distortion_as_printed());
}

}  // namespace
}  // namespace hydrodip
