// The fast solver of the film's equilibrium against the direct one, to the end of a dip.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "dip/dip.h"
#include "elastic/table_law.h"
#include "exact/dipping.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

constexpr double kPrecision_mm = 1e-4;

FilmMesh coarse_film(int elements) {
  return make_film_mesh({.width_mm = 150, .height_mm = 180, .elements = elements});
}

exact::StraightDip shallow_dip() {
  exact::StraightDip options;
  options.step_mm = 0.25;
  options.even_steps = true;
  options.depth_mm = 12;
  return options;
}

// K_max / K_min of the paper between neighbouring squares.
std::vector<double> checkerboard(const FilmMesh& film, double square_mm) {
  std::vector<double> modulus;
  for (const Triangle& t : film.triangles) {
    const Vec2 centre =
        (film.u[std::size_t(t[0])] + film.u[std::size_t(t[1])] + film.u[std::size_t(t[2])]) / 3;
    const Vec2 square = (centre / square_mm).array().floor();
    modulus.push_back(std::fmod(std::abs(square.sum()), 2) == 0 ? 1 : 600);
  }
  return modulus;
}

DippedFilm dipped(const FilmMesh& film, const exact::StraightDip& options,
                  DipStatistics* statistics = {}) {
  const shapes::Shape sphere = shapes::sphere_bowl(30, 28);
  const Surface surface(sphere.positions, sphere.triangles);
  RunContext context;
  const DipResult result = dip(film, sphere.positions, sphere.triangles, surface,
                               Trajectory::straight_down(options.depth_mm), options, context);
  if (statistics) *statistics = result.statistics;
  return result.film;
}

double largest_distance(const DippedFilm& a, const DippedFilm& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.position.size(); ++v)
    largest = std::max(largest, (a.position[v] - b.position[v]).norm());
  return largest;
}

void expect_the_same_film(exact::StraightDip options, const FilmMesh& film) {
  const DippedFilm fast = dipped(film, options);
  options.make_solver = [](const FilmMesh&) { return make_direct_solver(); };
  const double apart_mm = largest_distance(fast, dipped(film, options));
  testing::Test::RecordProperty("apart_mm", fmt::format("{:.2g}", apart_mm));
  EXPECT_LT(apart_mm, kPrecision_mm);
}

// In even steps of the default length, and with enough nodes for all that the solver does on large
// films. In longer steps, film that touches just as a step ends makes more of a difference than
// either solver.
constexpr int kElements = 10000;

exact::StraightDip usual_dip() {
  exact::StraightDip options;
  options.even_steps = true;
  options.depth_mm = 8;
  options.material.tear_stretch = 0;
  return options;
}

TEST(SolverSlow, MultigridGivesTheDirectSolversFilm) {
  expect_the_same_film(usual_dip(), coarse_film(kElements));
}

TEST(SolverSlow, MultigridGivesTheDirectSolversFilmWithPoissonsRatio) {
  exact::StraightDip options = usual_dip();
  options.material.poisson = 0.35;
  expect_the_same_film(options, coarse_film(kElements));
}

TEST(SolverSlow, MultigridGivesTheDirectSolversFilmOnHardInk) {
  const FilmMesh film = coarse_film(kElements);
  exact::StraightDip options = usual_dip();
  options.modulus = checkerboard(film, 8);
  expect_the_same_film(options, film);
}

// The paper's energy as a law of one's own, and as a table of that: other loops, the same film.
TEST(SolverSlow, PapersLawGivesTheBuiltInFilm) {
  const FilmMesh film = coarse_film(kElements);
  exact::StraightDip options = usual_dip();
  options.modulus = checkerboard(film, 8);
  for (const double poisson : {0.0, 0.35}) {
    options.material.poisson = poisson;
    options.material.law = nullptr;
    const DippedFilm built_in = dipped(film, options);
    const auto law = make_corotated_law(poisson);
    const LawTable table = tabulated([&](double a, double b) { return law->at(a, b).energy; });
    for (const auto& same : {law, make_table_law(table)}) {
      options.material.law = same;
      const double apart_mm = largest_distance(built_in, dipped(film, options));
      testing::Test::RecordProperty("apart_mm", fmt::format("{:.2g}", apart_mm));
      EXPECT_LT(apart_mm, kPrecision_mm) << poisson;
    }
  }
}

TEST(SolverSlow, IterationsDoNotGrowWithTheMesh) {
  exact::StraightDip options = shallow_dip();
  options.depth_mm = 3;
  DipStatistics coarse, fine;
  dipped(coarse_film(2000), options, &coarse);
  dipped(coarse_film(50000), options, &fine);
  const auto per_step = [](const DipStatistics& s) { return double(s.iterations) / s.steps; };
  EXPECT_LT(per_step(fine), 1.3 * per_step(coarse));
  EXPECT_LT(per_step(fine), 5);
}

}  // namespace
}  // namespace hydrodip
