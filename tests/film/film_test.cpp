#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "film/locate.h"

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
  for (const Triangle& t : mesh.triangles) EXPECT_GT(signed_area(mesh, t), 0);
  for (std::size_t v = 0; v < mesh.u.size(); ++v) {
    const bool edge = std::abs(std::abs(mesh.u[v].x()) - 95) < 1e-9 ||
                      std::abs(std::abs(mesh.u[v].y()) - 138.5) < 1e-9;
    EXPECT_EQ(bool(mesh.on_rim[v]), edge);
  }
}

TEST(Film, DiscIsRoundAndValidAtAnyResolution) {
  for (int elements : {60, 200, 1000, 2717, 10000, 40000})
    for (double grading : {1.0, 4.0, 8.0}) {
      const FilmMesh mesh = make_film_mesh({.width_mm = 220,
                                            .height_mm = 300,
                                            .shape = FilmShape::kDisc,
                                            .margin_mm = 10,
                                            .elements = elements,
                                            .grading = grading});
      // A polygon with m rim vertices misses about 2 pi^2 / (3 m^2) of the disc.
      const double relative = total_area(mesh) / (M_PI * 100 * 100);
      EXPECT_NEAR(relative, 1, 30.0 * grading / elements) << elements << " " << grading;
      EXPECT_NEAR(double(mesh.triangles.size()) / elements, 1, 0.02 + 5 / std::sqrt(elements))
          << elements << " " << grading;
      for (const Triangle& t : mesh.triangles)
        EXPECT_GT(signed_area(mesh, t), 0.02 / grading * mesh.cell_mm * mesh.cell_mm)
            << elements << " " << grading;
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

TEST(Film, GradingMakesCellsSmallerAtTheCentre) {
  const FilmMesh mesh = make_film_mesh({.elements = 20000, .grading = 4});
  const auto gap = [&](std::size_t i) { return mesh.line_x[i + 1] - mesh.line_x[i]; };
  const std::size_t middle = mesh.line_x.size() / 2;
  EXPECT_NEAR(gap(0) / gap(middle), 4, 0.15);
  const FilmMesh even = make_film_mesh({.elements = 20000, .grading = 1});
  for (std::size_t i = 0; i + 1 < even.line_x.size(); ++i)
    EXPECT_NEAR(even.line_x[i + 1] - even.line_x[i], 190.0 / double(even.nx - 1), 1e-9);
}

TEST(Film, LocatingFindsEveryPoint) {
  for (FilmShape shape : {FilmShape::kRectangle, FilmShape::kDisc}) {
    const FilmMesh mesh = make_film_mesh({.shape = shape, .elements = 3000});
    for (int i = 0; i < 2000; ++i) {
      const Vec2 p(90 * std::sin(1.7 * i) * (shape == FilmShape::kDisc ? 0.7 : 1.0),
                   (shape == FilmShape::kDisc ? 63 : 130) * std::sin(2.3 * i + 1));
      const FilmLocation at = locate_flat(mesh, p);
      ASSERT_TRUE(at.inside) << p.transpose();
      Vec2 back = Vec2::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        back += at.weight[Eigen::Index(k)] *
                mesh.u[std::size_t(mesh.triangles[std::size_t(at.triangle)][k])];
      EXPECT_LT((back - p).norm(), 1e-9);
    }
    EXPECT_FALSE(locate_flat(mesh, {200, 0}).inside);
    EXPECT_FALSE(locate_flat(mesh, {0, -1e30}).inside);
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

// Folded over itself, film lies with its underside up: what is there is the film around it.
TEST(Film, LocatingPassesFilmThatIsTurnedOver) {
  const FilmMesh mesh = make_film_mesh({.elements = 300});
  std::vector<Vec2> u = mesh.u;
  const auto folded = std::size_t(locate_flat(mesh, {10, 10}).triangle);
  const auto moved = std::size_t(mesh.triangles[folded][0]);
  u[moved] += Vec2(1.7, 0.4) * mesh.cell_mm;
  const auto area = [&](std::size_t t) {
    const Triangle& v = mesh.triangles[t];
    const Vec2& a = u[std::size_t(v[0])];
    return cross2(u[std::size_t(v[1])] - a, u[std::size_t(v[2])] - a);
  };
  const std::vector<std::uint8_t> usable(mesh.triangles.size(), 1);
  int turned = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (area(t) > 0) continue;
    ++turned;
    Vec2 centre = Vec2::Zero();
    for (const std::int32_t v : mesh.triangles[t]) centre += u[std::size_t(v)] / 3;
    for (const std::int32_t start : mesh.triangles[t]) {
      const FilmLocation at = locate(mesh, u, usable, start, centre, std::int32_t(t));
      EXPECT_TRUE(!at.inside || area(std::size_t(at.triangle)) > 0) << t;
    }
  }
  EXPECT_GT(turned, 0);
}

// Each corner has to be attached, and the film whole.
TEST(DippedFilm, LiesOnTheObjectWithAllItsCorners) {
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(make_film_mesh({.elements = 300}));
  const FilmMesh& mesh = film.mesh();
  const std::size_t t = 40;
  for (const bool told : {false, true})
    for (int attached = 0; attached < 8; ++attached) {
      film.state.assign(mesh.u.size(), VertexState::kUnattached);
      film.torn.assign(told ? mesh.triangles.size() : 0, 0);
      for (std::size_t k = 0; k < 3; ++k)
        if (attached & 1 << k)
          film.state[std::size_t(mesh.triangles[t][k])] = VertexState::kAttached;
      EXPECT_EQ(film.lies_on_object(t), attached == 7);
    }
  film.torn[t] = 1;
  EXPECT_FALSE(film.lies_on_object(t));
  EXPECT_EQ(film.whole_part(t).share, 0);
  film.torn[t] = 0;
  EXPECT_NEAR(film.whole_part(t).share, 1, 1e-12);
}

// A line through the film, straight in film coordinates, along which it is torn.
DippedFilm torn_beyond(double x_mm, double slope) {
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(
      make_film_mesh({.width_mm = 80, .height_mm = 70, .elements = 500}));
  for (const Vec2& u : film.mesh().u) {
    film.position.emplace_back(u.x(), u.y(), 0);
    film.excess.push_back(u.x() + slope * u.y() - x_mm);
  }
  film.state.assign(film.position.size(), VertexState::kAttached);
  film.torn.assign(film.mesh().triangles.size(), 0);
  return film;
}

TEST(DippedFilm, WholePartsEndAtTheTearLine) {
  for (const double slope : {0.0, 0.3, -2.0}) {
    const DippedFilm film = torn_beyond(4.3, slope);
    double whole = 0;
    for (std::size_t t = 0; t < film.torn.size(); ++t) {
      const Triangle& v = film.mesh().triangles[t];
      const DippedFilm::Part part = film.whole_part(t);
      const auto place = [&](const Vec3& weight) {
        Vec2 u = Vec2::Zero();
        for (std::size_t k = 0; k < 3; ++k)
          u += weight[Eigen::Index(k)] * film.mesh().u[std::size_t(v[k])];
        return u;
      };
      for (std::size_t k = 0; k < part.corners; ++k) {
        const Vec2 from = place(part.corner[k]), to = place(part.corner[(k + 1) % part.corners]);
        EXPECT_LT(from.x() + slope * from.y(), 4.3 + 1e-9);
        const auto off = [&](const Vec2& u) { return std::abs(u.x() + slope * u.y() - 4.3); };
        if (part.side[k] == 3) {
          EXPECT_LT(off(from) + off(to), 1e-9);
        } else {  // along the side opposite that corner
          EXPECT_NEAR(part.corner[k][part.side[k]], 0, 1e-12);
          EXPECT_NEAR(part.corner[(k + 1) % part.corners][part.side[k]], 0, 1e-12);
        }
      }
      const Vec2& a = film.mesh().u[std::size_t(v[0])];
      whole += part.share * 0.5 *
               cross2(film.mesh().u[std::size_t(v[1])] - a, film.mesh().u[std::size_t(v[2])] - a);
    }
    // Of the rectangle of 60 by 50 mm: a straight cut through its middle height at x = 4.3, as long
    // as it leaves through the long sides.
    if (std::abs(slope) < 0.9) {
      EXPECT_NEAR(whole, 50 * (30 + 4.3), 1e-9) << slope;
    }
  }
}

}  // namespace
}  // namespace hydrodip
