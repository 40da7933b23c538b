// Film that has swollen on the water.
#include <gtest/gtest.h>

#include "exact/dipping.h"

namespace hydrodip {
namespace {

using exact::kClampRadius;
using exact::kZStretch;

// On the water it is a larger disc, clamped farther out; what lands is told in the printed sheet's
// millimetres.
TEST(Swelling, LandsAsTheExactSolutionOfTheLargerDisc) {
  constexpr double kSwelling = 1.02, R = 30;
  FilmMesh film = make_film_mesh({.width_mm = 220,
                                  .height_mm = 220,
                                  .shape = FilmShape::kDisc,
                                  .margin_mm = 10,
                                  .elements = 10000,
                                  .swelling_x = kSwelling,
                                  .swelling_y = kSwelling});
  const auto on_water = [](double a) {
    return exact::revolution(a, kSwelling * kClampRadius, kZStretch,
                             [](double r) { return r / std::sqrt(R * R - r * r); });
  };
  const auto options = exact::untearing(0.2, R - std::sqrt(R * R - 28.4 * 28.4));
  const DippedFilm dipped = exact::dip_shape(shapes::sphere_bowl(R, 29.5), film, options);
  int compared = 0;
  double worst = 0;
  for (std::size_t v = 0; v < film.u.size(); v += 7) {
    const double a = dipped.position[v].head<2>().norm();
    if (dipped.state[v] != VertexState::kAttached || a < 3 || a > 27) continue;
    worst = std::max(worst, std::abs(dipped.mesh().u[v].norm() - on_water(a) / kSwelling));
    ++compared;
  }
  EXPECT_GT(compared, 100);
  EXPECT_LT(worst, 0.05);
  // Where the object first touches, a printed square millimetre has become this many.
  for (std::size_t v = 0; v < film.u.size(); ++v)
    if (film.u[v].norm() < 1e-9) {
      EXPECT_NEAR(dipped.area_ratio[v], kSwelling * kSwelling, 0.003);
    }
}

// Unevenly swollen: the same as film that was as large from the start, but for rounding, which
// decides where within its tolerance (2.5e-5 mm in steps of 0.5 mm) each step's relaxation ends.
// Feet carry that on: 1e-5 mm where the object first touches are up to 6e-4 along one meridian.
TEST(Swelling, IsAsFilmOfThatSize) {
  constexpr double x = 1.025, y = 1.015, kRounding_mm = 1e-3;
  const FilmMesh swollen = make_film_mesh({.width_mm = 140,
                                           .height_mm = 160,
                                           .margin_mm = 10,
                                           .elements = 3000,
                                           .swelling_x = x,
                                           .swelling_y = y});
  const FilmMesh large = make_film_mesh(
      {.width_mm = 120 * x + 20, .height_mm = 140 * y + 20, .margin_mm = 10, .elements = 3000});
  ASSERT_EQ(swollen.u.size(), large.u.size());
  for (std::size_t v = 0; v < large.u.size(); ++v)
    ASSERT_LT((swollen.wet[v] - large.u[v]).norm(), 1e-9);
  const auto options = exact::untearing(0.5, 10);
  const shapes::Shape ball = shapes::sphere_bowl(30, 29.5, 60, 80);
  const DippedFilm a = exact::dip_shape(ball, swollen, options);
  const DippedFilm b = exact::dip_shape(ball, large, options);
  for (std::size_t v = 0; v < large.u.size(); ++v) {
    EXPECT_EQ(a.state[v], b.state[v]);
    EXPECT_LT((a.position[v] - b.position[v]).norm(), kRounding_mm);
    EXPECT_NEAR(a.area_ratio[v], x * y * b.area_ratio[v], kRounding_mm);
    EXPECT_NEAR(a.stretch[v], b.stretch[v], kRounding_mm);
    EXPECT_EQ(a.mesh().u[v], swollen.u[v]);
  }
}

}  // namespace
}  // namespace hydrodip
