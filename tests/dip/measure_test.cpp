// What film is measured by, on film stretched by hand.
#include "dip/measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exact/shapes.h"

namespace hydrodip {
namespace {

FilmMesh film_mesh() {
  return make_film_mesh({.width_mm = 60, .height_mm = 60, .margin_mm = 10, .elements = 300});
}

// All film on a plane that faces down, after a linear map of it.
DipState laid_flat(const FilmMesh& film, const Mat2& stretch) {
  DipState state;
  for (const Vec2& u : film.u) {
    const Vec2 x = stretch * u;
    state.position.emplace_back(x.x(), x.y(), 0);
  }
  state.state.assign(film.u.size(), VertexState::kAttached);
  state.torn.assign(film.triangles.size(), 0);
  state.torn_at_mm.assign(film.triangles.size(), 1e300);
  return state;
}

DippedFilm measured_on_plane(const FilmMesh& film, const DipState& state, double tear_stretch) {
  const shapes::Shape slab = shapes::box(Vec3(-99, -99, 0), Vec3(99, 99, 5));
  const Surface surface(slab.positions, slab.triangles);
  DipOptions options;
  options.material.tear_stretch = tear_stretch;
  return measured(std::make_shared<const FilmMesh>(film), state, options, surface);
}

TEST(Measure, KnowsUniformStretchExactly) {
  const FilmMesh film = film_mesh();
  Mat2 turn;
  turn << 0.8, -0.6, 0.6, 0.8;
  for (const Vec2& factors : {Vec2(1, 1), Vec2(1.3, 1.1), Vec2(0.9, 1.25), Vec2(2, 0.5)})
    for (const Mat2& frame : {Mat2(Mat2::Identity()), turn}) {
      // Stretched along one pair of axes, then turned: rotations must not count.
      const Mat2 map = turn * frame * factors.asDiagonal() * frame.transpose();
      const DippedFilm result = measured_on_plane(film, laid_flat(film, map), 0);
      for (std::size_t v = 0; v < film.u.size(); ++v) {
        // Where both principal stretches agree, rounding goes in by its square root.
        EXPECT_NEAR(result.stretch[v], factors.maxCoeff(), 1e-7);
        EXPECT_NEAR(result.area_ratio[v], factors.prod(), 1e-12);
      }
    }
}

// Film over the edge between a bottom, on which it is as it was, and a wall, on which it is
// stretched upwards: between the two, not pressed together as the chords across the edge are.
TEST(Measure, FilmOverAnEdgeIsAsOnItsFaces) {
  const FilmMesh film = film_mesh();
  constexpr double kHalf = 10.3, kHeight = 0.65;
  DipState state = laid_flat(film, Mat2::Identity());
  for (Vec3& p : state.position)
    if (const double beyond = std::abs(p.x()) - kHalf; beyond > 0)
      p = Vec3(std::copysign(kHalf, p.x()), p.y(), beyond / kHeight);
  const shapes::Shape slab = shapes::box(Vec3(-kHalf, -99, 0), Vec3(kHalf, 99, 50));
  const Surface surface(slab.positions, slab.triangles);
  DipOptions options;
  options.material.tear_stretch = 0;
  options.material.z_stretch = kHeight;
  const DippedFilm result =
      measured(std::make_shared<const FilmMesh>(film), state, options, surface);
  EXPECT_EQ(std::count(result.wrinkled.begin(), result.wrinkled.end(), 1), 0);
  int beside = 0;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    EXPECT_GT(result.area_ratio[v], 1 - 1e-9) << film.u[v].transpose();
    EXPECT_LT(result.area_ratio[v], 1 / kHeight + 1e-9) << film.u[v].transpose();
    const double beyond = std::abs(film.u[v].x()) - kHalf;
    if (std::abs(beyond) > 2 * film.cell_mm) {
      EXPECT_NEAR(result.area_ratio[v], beyond < 0 ? 1 : 1 / kHeight, 1e-9);
    } else {
      ++beside;
    }
  }
  EXPECT_GT(beside, 20);
}

TEST(Measure, TearsWhatIsStretchedBeyondTheLimit) {
  const FilmMesh film = film_mesh();
  const DipState state = laid_flat(film, Vec2(1.5, 1).asDiagonal());
  const auto torn = [&](double limit) {
    const DippedFilm result = measured_on_plane(film, state, limit);
    return std::count(result.torn.begin(), result.torn.end(), 1);
  };
  EXPECT_EQ(torn(1.4), std::ptrdiff_t(film.triangles.size()));
  EXPECT_EQ(torn(1.51), 0);
  EXPECT_EQ(torn(0), 0);  // never tears
}

// What the first dip decided is not decided anew by a hair; film that never lets go never does.
TEST(Measure, FilmThatIsToldWhenToTearBearsMoreThanOther) {
  DipOptions options;
  const double limit = let_go_limit(options);
  ASSERT_GT(limit, options.material.tear_stretch - 1e-12);
  options.tears_at_mm = {1e300};
  EXPECT_GT(let_go_limit(options), 1.1 * limit);
  options.material.tear_stretch = 0;
  EXPECT_EQ(let_go_limit(options), 0);
  options.tears_at_mm.clear();
  EXPECT_EQ(let_go_limit(options), 0);
}

TEST(Measure, KnowsWhatIsPressedTogether) {
  const FilmMesh film = film_mesh();
  const auto wrinkled = [&](double factor) {
    const DipState state = laid_flat(film, Vec2(factor, 1.2).asDiagonal());
    const DippedFilm result = measured_on_plane(film, state, 0);
    return std::count(result.wrinkled.begin(), result.wrinkled.end(), 1);
  };
  EXPECT_EQ(wrinkled(0.94), std::ptrdiff_t(film.triangles.size()));
  EXPECT_EQ(wrinkled(0.96), 0);
}

// Film that floats is stretched at will: only film on the object is judged here.
TEST(Measure, VerticesOnTheObjectAreMeasuredOnTheFilmThatLiesThere) {
  const FilmMesh film = film_mesh();
  DipState state = laid_flat(film, Vec2(1.2, 1).asDiagonal());
  for (std::size_t v = 0; v < film.u.size(); ++v)
    if (film.u[v].x() > 5) {  // floats, and is drawn out far
      state.position[v].x() *= 3;
      state.state[v] = VertexState::kUnattached;
    }
  const DippedFilm result = measured_on_plane(film, state, 1.4);
  for (std::size_t v = 0; v < film.u.size(); ++v)
    if (film.u[v].x() < 5 && film.u[v].x() > -30) {
      EXPECT_NEAR(result.stretch[v], 1.2, 1e-7);
      EXPECT_NEAR(result.area_ratio[v], 1.2, 1e-12);
    }
  for (std::size_t t = 0; t < film.triangles.size(); ++t) EXPECT_FALSE(result.torn[t]);
}

}  // namespace
}  // namespace hydrodip
