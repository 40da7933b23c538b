// A dip that begins where another found its film.
#include "dip/foresight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "dip/dip.h"
#include "exact/dipping.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

DipOptions foreseeing(const std::shared_ptr<RelaxedSteps>& steps) {
  DipOptions options;
  options.step_mm = 0.2;
  options.material.tear_stretch = 0;
  options.relaxed_steps = steps;
  return options;
}

DipResult dip_of_sphere(const FilmMesh& film, const DipOptions& options) {
  const shapes::Shape sphere = shapes::sphere_bowl(20, 15);
  const Surface surface(sphere.positions, sphere.triangles);
  RunContext context;
  return dip(film, sphere.positions, sphere.triangles, surface,
             make_trajectory({}, sphere.positions), options, context);
}

// As ink does: up to three times as stiff, in patches some millimetres wide.
std::vector<double> patches(const FilmMesh& film, double most) {
  std::vector<double> modulus;
  for (const Triangle& t : film.triangles) {
    const Vec2& at = film.u[std::size_t(t[0])];
    modulus.push_back(std::sin(at.x()) * std::sin(at.y()) > 0 ? most : 1);
  }
  return modulus;
}

double farthest_apart(const DippedFilm& a, const DippedFilm& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.position.size(); ++v)
    most = std::max(most, (a.position[v] - b.position[v]).norm());
  return most;
}

TEST(Foresight, FindsTheSameFilmInFewerIterations) {
  const FilmMesh film = exact::disc_film(6000);
  const auto kept = std::make_shared<RelaxedSteps>();
  DipOptions options = foreseeing(kept);
  options.modulus = patches(film, 3);
  const DipResult before = dip_of_sphere(film, options);
  ASSERT_EQ(kept->ends_mm.size(), before.statistics.steps_at_mm.size());

  DipOptions other = foreseeing(nullptr);
  other.modulus = patches(film, 3.1);
  other.steps_at_mm = before.statistics.steps_at_mm;
  const DipResult alone = dip_of_sphere(film, other);
  other.relaxed_steps = kept;
  const DipResult foreseen = dip_of_sphere(film, other);

  EXPECT_LT(foreseen.statistics.iterations, 0.6 * double(alone.statistics.iterations));
  EXPECT_GT(farthest_apart(before.film, alone.film), 2e-3);
  EXPECT_LT(farthest_apart(foreseen.film, alone.film), 1e-4);
}

TEST(Foresight, IsOfTheSameStepsOnly) {
  const FilmMesh film = exact::disc_film(2000);
  const auto kept = std::make_shared<RelaxedSteps>();
  dip_of_sphere(film, foreseeing(kept));
  DipOptions options = foreseeing(nullptr);
  options.step_mm = 0.3;
  const DipResult alone = dip_of_sphere(film, options);
  options.relaxed_steps = kept;
  const DipResult other = dip_of_sphere(film, options);
  EXPECT_EQ(farthest_apart(other.film, alone.film), 0);
  EXPECT_EQ(other.statistics.iterations, alone.statistics.iterations);
  EXPECT_EQ(kept->ends_mm.size(), other.statistics.steps_at_mm.size());
}

TEST(Foresight, GoesOnByAsMuchAsTheFilmWasFurtherOn) {
  const FilmMesh film = exact::disc_film(200);
  const FilmGrid grid(film);
  const GridField flat = grid.field(film.u);
  const auto moved_by = [&](double x_mm) {
    GridField field = flat;
    for (std::size_t v = 0; v < film.u.size(); ++v)
      field.set(grid.place(v), film.u[v] + Vec2(x_mm, -x_mm));
    return field;
  };
  RelaxedSteps kept;
  {
    Foresight first(grid.layout(), flat, &kept);
    for (int step = 1; step <= 3; ++step) {
      GridField field = moved_by(7);
      first.foresee(step, field);  // knows nothing
      EXPECT_EQ(field.at(grid.place(0)), moved_by(7).at(grid.place(0)));
      first.keep(moved_by(0.25 * step));
    }
  }
  Foresight second(grid.layout(), flat, &kept);
  GridField field = flat;
  second.foresee(1, field);
  EXPECT_EQ(field.at(grid.place(5)), moved_by(0.25).at(grid.place(5)));
  second.keep(moved_by(0.25 + 0.125));
  second.foresee(2, field);
  EXPECT_EQ(field.at(grid.place(5)), moved_by(0.5 + 0.125).at(grid.place(5)));
  second.keep(moved_by(0.5));
  second.foresee(2.9, field);  // another way from here on
  EXPECT_EQ(field.at(grid.place(5)), moved_by(0.5 + 0.125).at(grid.place(5)));
  EXPECT_EQ(kept.ends_mm.size(), 2u);
}

}  // namespace
}  // namespace hydrodip
