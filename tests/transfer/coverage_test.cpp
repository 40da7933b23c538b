// How much of an object is under film, against areas in closed form.
#include "transfer/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

constexpr double kLine_mm = 1.5, kHole_mm = 6;

// A grid of which no line is on an edge at 20 mm.
FilmMesh film_of_squares() {
  GridLines lines;
  for (int k = -18; k <= 18; ++k) lines.x.push_back(k * kLine_mm);
  lines.y = lines.x;
  return make_film_mesh({.width_mm = 60, .height_mm = 60, .margin_mm = 3}, lines);
}

// Rolled on without stretch where it is to lie, and torn over a square in the middle.
DippedFilm laid_film(const std::function<Vec3(const Vec2& u)>& place,
                     const std::function<bool(const Vec2& u)>& lies) {
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(film_of_squares());
  const FilmMesh& mesh = film.mesh();
  for (const Vec2& u : mesh.u) {
    film.position.push_back(place(u));
    film.state.push_back(lies(u) ? VertexState::kAttached : VertexState::kUnattached);
  }
  for (const Triangle& triangle : mesh.triangles)
    film.torn.push_back(std::all_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
      return mesh.u[std::size_t(v)].cwiseAbs().maxCoeff() < kHole_mm + 1e-9;
    }));
  film.area_ratio.assign(mesh.u.size(), 1);
  film.stretch.assign(mesh.u.size(), 1);
  film.depth_mm = 12;
  return film;
}

Coverage coverage_of(const Object& object, const DippedFilm& film) {
  return measure_coverage(object, Surface(object.positions, object.triangles), film);
}

TEST(Coverage, OfAPrismIsThatOfItsBottomAndOfItsWalls) {
  const double half_mm = fixtures::kHalfSide_mm, up_mm = 5.5, half_length_mm = 18;
  const auto place = [&](const Vec2& u) {
    const double beyond = std::max(0.0, std::abs(u.x()) - half_mm);
    return Vec3(std::copysign(std::min(std::abs(u.x()), half_mm), u.x()), u.y(), beyond);
  };
  const auto lies = [&](const Vec2& u) {
    return std::abs(u.x()) < half_mm + up_mm + 1e-9 && std::abs(u.y()) < half_length_mm + 1e-9;
  };
  const Coverage c = coverage_of(fixtures::slab(), laid_film(place, lies));
  const double hole_mm2 = 4 * kHole_mm * kHole_mm;
  const double bottom_mm2 = 4 * half_mm * half_length_mm - hole_mm2;
  EXPECT_NEAR(c.downward_mm2, 4 * half_mm * half_mm, 1e-9);
  EXPECT_NEAR(c.covered_downward_mm2, bottom_mm2, 1e-6);
  EXPECT_NEAR(c.covered_mm2, bottom_mm2 + 4 * up_mm * half_length_mm, 1e-6);
  EXPECT_NEAR(c.film_on_object_mm2, c.covered_mm2, 1e-6);
}

// A round wall is as upright as a flat one, whatever way the chords between its places lean.
TEST(Coverage, OfACylinderIsThatOfItsBottom) {
  const double radius_mm = 16, up_mm = 6;
  const auto place = [&](const Vec2& u) {
    const double beyond = std::max(0.0, u.norm() - radius_mm);
    const Vec2 at = beyond > 0 ? Vec2(radius_mm * u.normalized()) : u;
    return Vec3(at.x(), at.y(), beyond);
  };
  const auto lies = [&](const Vec2& u) { return u.norm() < radius_mm + up_mm; };
  const auto meridian = [&](double t) {
    return t < 0.5 ? Vec2(2 * t * radius_mm, 0) : Vec2(radius_mm, 24 * t - 12);
  };
  const Object cylinder = fixtures::plain_object(shapes::revolve(meridian, 20, 360));
  const Coverage c = coverage_of(cylinder, laid_film(place, lies));
  const double disc_mm2 = std::numbers::pi * radius_mm * radius_mm;
  const double covered_mm2 = disc_mm2 - 4 * kHole_mm * kHole_mm;
  EXPECT_NEAR(c.downward_mm2, disc_mm2, 0.001 * disc_mm2);
  EXPECT_NEAR(c.covered_downward_mm2, covered_mm2, 0.005 * covered_mm2);
}

}  // namespace
}  // namespace hydrodip
