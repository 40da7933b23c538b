#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace hydrodip {
namespace {

double signed_area(const FilmMesh& mesh, const Triangle& t) {
  const Vec2 &a = mesh.u[std::size_t(t[0])], &b = mesh.u[std::size_t(t[1])],
             &c = mesh.u[std::size_t(t[2])];
  return 0.5 * cross2(b - a, c - a);
}

double total_area(const FilmMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += signed_area(mesh, t);
  return area;
}

bool has_vertex_at(const FilmMesh& mesh, const Vec2& p) {
  for (const Vec2& u : mesh.u)
    if ((u - p).norm() < 1e-9) return true;
  return false;
}

TEST(Film, RectangleCoversTheFreeSheet) {
  const FilmMesh mesh = make_film_mesh({.width_mm = 210, .height_mm = 297, .margin_mm = 10});
  EXPECT_NEAR(total_area(mesh), 190.0 * 277.0, 1e-6);
  EXPECT_NEAR(double(mesh.triangles.size()), 40000, 600);
  EXPECT_NEAR(mesh.spacing.x() / mesh.spacing.y(), 1, 0.02);
  for (const Triangle& t : mesh.triangles) EXPECT_GT(signed_area(mesh, t), 0);
  for (std::size_t v = 0; v < mesh.u.size(); ++v) {
    const bool edge = std::abs(std::abs(mesh.u[v].x()) - 95) < 1e-9 ||
                      std::abs(std::abs(mesh.u[v].y()) - 138.5) < 1e-9;
    EXPECT_EQ(bool(mesh.on_rim[v]), edge);
  }
}

TEST(Film, DiscIsRoundAndValidAtAnyResolution) {
  for (int elements : {60, 200, 1000, 2717, 10000, 40000}) {
    const FilmMesh mesh = make_film_mesh({.width_mm = 220,
                                          .height_mm = 300,
                                          .shape = FilmShape::kDisc,
                                          .margin_mm = 10,
                                          .elements = elements});
    // A polygon with m rim vertices misses about 2 pi^2 / (3 m^2) of the disc.
    const double relative = total_area(mesh) / (M_PI * 100 * 100);
    EXPECT_NEAR(relative, 1, 30.0 / elements) << elements;
    EXPECT_NEAR(double(mesh.triangles.size()), elements, 12 * std::sqrt(elements)) << elements;
    for (const Triangle& t : mesh.triangles)
      EXPECT_GT(signed_area(mesh, t), 0.02 * mesh.cell_mm * mesh.cell_mm) << elements;
    for (std::size_t v = 0; v < mesh.u.size(); ++v)
      if (mesh.on_rim[v])
        EXPECT_NEAR(mesh.u[v].norm(), 100, 1e-9);
      else
        EXPECT_LT(mesh.u[v].norm(), 100);
  }
}

TEST(Film, GridIsSymmetric) {
  const FilmMesh mesh = make_film_mesh({.width_mm = 100,
                                        .height_mm = 100,
                                        .shape = FilmShape::kDisc,
                                        .margin_mm = 5,
                                        .elements = 500});
  for (const Vec2& u : mesh.u) {
    EXPECT_TRUE(has_vertex_at(mesh, {-u.x(), u.y()}));
    EXPECT_TRUE(has_vertex_at(mesh, {-u.y(), u.x()}));
  }
}

TEST(Film, NeighborsShareAnEdge) {
  const FilmMesh mesh = make_film_mesh({.elements = 300});
  long boundary = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t n = mesh.neighbor[t][k];
      if (n < 0) {
        ++boundary;
        continue;
      }
      int shared = 0;
      for (std::int32_t a : mesh.triangles[t])
        for (std::int32_t b : mesh.triangles[std::size_t(n)]) shared += a == b;
      EXPECT_EQ(shared, 2);
    }
  EXPECT_EQ(boundary, 2 * (mesh.nx - 1) + 2 * (mesh.ny - 1));
}

TEST(Film, RefusesAMarginThatLeavesNothing) {
  EXPECT_THROW(make_film_mesh({.width_mm = 20, .height_mm = 50, .margin_mm = 10}), InputError);
}

}  // namespace
}  // namespace hydrodip
