// The inner loops: the same bytes from every instruction set, and the numbers of the plain
// formulas.

#include "elastic/kernels.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <vector>

#include "elastic/by_vertex.h"
#include "elastic/corotated.h"
#include "elastic/film_energy.h"
#include "elastic/kernel_variants.h"
#include "elastic/multigrid.h"

namespace hydrodip {
namespace {

// A film with every triangle strained differently, some left out.
struct StrainedFilm {
  FilmMesh mesh =
      make_film_mesh({.width_mm = 70, .height_mm = 90, .margin_mm = 5, .elements = 700});
  VertexVector u = mesh.u;
  FilmEnergy energy{mesh, {}, 0.3};
  std::vector<std::uint8_t> is_free;

  StrainedFilm() {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (Vec2& p : u) p += 0.2 * mesh.cell_mm * Vec2(unit(generator), unit(generator));
    VertexVector place = mesh.u;
    for (Vec2& p : place) p += 0.1 * mesh.cell_mm * Vec2(unit(generator), unit(generator));
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 17) energy.set_film(t, false);
    energy.set_flat_rest(energy.grid().field(place), 0);
    for (std::uint8_t rim : mesh.on_rim) is_free.push_back(!rim);
  }
};

GridVector some_way(const FilmGrid& grid) {
  GridVector way(grid.layout());
  for (std::size_t v = 0; v < grid.vertices(); ++v) {
    way.x()[grid.place(v)] = std::sin(float(v));
    way.y()[grid.place(v)] = std::cos(3 * float(v));
  }
  return way;
}

// Everything that a table computes from one film, one after the other.
std::vector<double> results_of(const kernels::Table& table) {
  const StrainedFilm film;
  const FilmGrid& grid = film.energy.grid();
  const kernels::Elements elements = film.energy.elements();
  const GridField u = grid.field(film.u);
  const std::size_t n = grid.elements();
  const int ny = grid.layout().ny;
  std::vector<double> results;
  const auto add = [&](const GridArray<double>& values, std::size_t count) {
    results.insert(results.end(), values.data(), values.data() + count);
  };

  GridField force(grid.layout());
  GridArray<double> mask(grid.layout().entries());
  grid.to_mask(film.is_free, mask);
  GridArray<double> scratch(std::size_t(kernels::kScratchRows * grid.layout().stride));
  results.push_back(double(table.gradient(elements, 0, ny, u, mask.data(), force, scratch.data())));
  add(force.x, grid.layout().entries());
  add(force.y, grid.layout().entries());
  std::vector<double> columns(std::size_t(grid.layout().stride));
  table.energy(elements, 0, ny - 1, u, columns.data());
  results.insert(results.end(), columns.begin(), columns.end());
  results.push_back(double(table.turned_over(elements, 0, ny - 1, u)));

  std::vector<std::int64_t> flags(n);
  table.overstretched(elements, 0, ny - 1, u, 1.2, flags.data());
  results.insert(results.end(), flags.begin(), flags.end());

  GridArray<double> rest[2][2], area(n), present(n), flat_area(n);
  for (auto& corner : rest)
    for (auto& component : corner) component = GridArray<double>(n);
  for (std::size_t e = 0; e < n; ++e) present[e] = flat_area[e] = grid.triangle(e) < 0 ? 0 : 1;
  double* const out[2][2] = {{rest[0][0].data(), rest[0][1].data()},
                             {rest[1][0].data(), rest[1][1].data()}};
  results.push_back(double(table.rest_shapes(elements, 0, ny - 1, u, present.data(),
                                             flat_area.data(), 0.5, out, area.data())));
  for (const auto& corner : rest)
    for (const auto& component : corner) add(component, n);
  add(area, n);

  const GridVector way = some_way(grid);
  const std::size_t entries = grid.layout().entries();
  GridField gone(grid.layout());
  const kernels::Stride stride = table.go(0, entries, u, way, 0.7, force, gone);
  results.insert(results.end(), {stride.slope, stride.largest_square});
  add(gone.x, entries);
  add(gone.y, entries);
  results.push_back(table.dot_field(0, entries, force, way));
  return results;
}

TEST(Kernels, EveryInstructionSetGivesTheSameBytes) {
  const std::vector<double> expected = results_of(*kernels::variants().front().table);
  ASSERT_GT(expected.size(), 5000U);
  for (const kernels::Variant& v : kernels::variants())
    EXPECT_EQ(results_of(*v.table), expected) << v.name;
}

TEST(Kernels, ForcesAreTheDerivativeOfTheEnergy) {
  const StrainedFilm film;
  const VertexVector gradient = fixtures::gradient_by_vertex(film.energy, film.u, film.is_free);
  constexpr double kStep = 1e-6;
  const auto value_of = [&](const VertexVector& u) {
    return film.energy.value(film.energy.grid().field(u));
  };
  for (std::size_t v = 0; v < film.u.size(); v += 7)
    for (Eigen::Index c = 0; c < 2; ++c) {
      VertexVector ahead = film.u, behind = film.u;
      ahead[v][c] += kStep;
      behind[v][c] -= kStep;
      const double slope = (value_of(ahead) - value_of(behind)) / (2 * kStep);
      EXPECT_NEAR(gradient[v][c], film.is_free[v] ? slope : 0, 1e-6);
    }
}

TEST(Kernels, OverstretchedIsWhereThePrincipalStretchPassesTheLimit) {
  const StrainedFilm film;
  for (const double limit : {1.05, 1.2, 1.6}) {
    std::vector<std::int32_t> expected;
    for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
      const Triangle& v = film.mesh.triangles[t];
      const RestTriangle rest = film.energy.rest(t);
      const Mat2 F = deformation_gradient(rest, film.u[std::size_t(v[0])],
                                          film.u[std::size_t(v[1])], film.u[std::size_t(v[2])]);
      if (rest.area > 0 && largest_stretch(F) > limit) expected.push_back(std::int32_t(t));
    }
    EXPECT_EQ(film.energy.overstretched(film.energy.grid().field(film.u), limit), expected);
    EXPECT_FALSE(expected.empty());
    EXPECT_LT(expected.size(), film.mesh.triangles.size());
  }
}

TEST(FilmEnergy, IsTheSumOfTheTriangles) {
  const StrainedFilm film;
  double sum = 0;
  for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
    const Triangle& v = film.mesh.triangles[t];
    const RestTriangle rest = film.energy.rest(t);
    if (!(rest.area > 0)) continue;
    const Mat2 F = deformation_gradient(rest, film.u[std::size_t(v[0])], film.u[std::size_t(v[1])],
                                        film.u[std::size_t(v[2])]);
    sum += rest.area * energy_density(F, film.energy.material(t));
  }
  EXPECT_NEAR(film.energy.value(film.energy.grid().field(film.u)), sum, 1e-12 * sum);
}

// Rest shapes come back corner by corner, whichever way a cell is cut.
TEST(FilmEnergy, FlatRestShapesAreThoseOfTheTriangles) {
  const StrainedFilm film;
  FilmEnergy energy(film.mesh, {}, 0.3);
  const std::vector<std::int32_t> small = energy.set_flat_rest(energy.grid().field(film.u), 0.9);
  std::size_t expected_small = 0;
  for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
    const Triangle& v = film.mesh.triangles[t];
    const auto triangle_in = [&](const VertexVector& at) {
      return rest_triangle(at[std::size_t(v[0])], at[std::size_t(v[1])], at[std::size_t(v[2])]);
    };
    const RestTriangle expected = triangle_in(film.u), found = energy.rest(t);
    EXPECT_NEAR(found.area, expected.area, 1e-12);
    EXPECT_LT((found.gradient - expected.gradient).norm(), 1e-12) << t;
    expected_small += expected.area < 0.9 * triangle_in(film.mesh.u).area;
    energy.set_rest(t, expected);
    EXPECT_LT((energy.rest(t).gradient - expected.gradient).norm(), 1e-14) << t;
  }
  EXPECT_EQ(small.size(), expected_small);
  EXPECT_GT(expected_small, 0U);
}

// Also where a disc leaves cells with one triangle, or none.
TEST(FilmGrid, HoldsEveryTriangleOfADisc) {
  const FilmMesh mesh = make_film_mesh({.width_mm = 90,
                                        .height_mm = 90,
                                        .shape = FilmShape::kDisc,
                                        .margin_mm = 5,
                                        .elements = 500});
  const FilmEnergy energy(mesh, {}, 0.2);
  const FilmGrid& grid = energy.grid();
  const kernels::Elements elements = energy.elements();
  const auto entries = grid.layout().entries();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t e = grid.element(t), a = e % entries, stride = std::size_t(elements.stride);
    ASSERT_EQ(grid.triangle(e), std::int32_t(t));
    const std::size_t row = a / stride - 1, column = a % stride - kernels::kLanes;
    const bool upper = e >= entries, rising = elements.rising[row % 2][column] > 0;
    const std::size_t b = a + 1, c = a + stride + 1, d = a + stride;
    const std::array<std::size_t, 3> expected =
        upper ? std::array{c, d, rising ? a : b} : std::array{a, b, rising ? c : d};
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(
          grid.place(std::size_t(mesh.triangles[t][(k + std::size_t(grid.first_corner(t))) % 3])),
          expected[k]);
  }
}

TEST(GridOperator, RowsComeBackAndTheOperatorIsSymmetric) {
  std::mt19937 generator(8);
  std::uniform_real_distribution<float> unit(-1, 1);
  GridOperator A(21, 9);
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 21; ++i) {
      GridOperator::Row row{};
      for (auto& block : row)
        for (float& e : block) e = 0.1F * unit(generator);
      row[4] = {1, 0.2F, 0.2F, 2};
      A.set_row(i, j, row);
    }
  for (int j = 1; j < 8; ++j)
    for (int i = 1; i < 20; ++i)
      for (int k = 0; k < 9; ++k) {
        const auto block = A.row(i, j)[std::size_t(k)];
        const auto opposite = A.row(i + k % 3 - 1, j + k / 3 - 1)[std::size_t(8 - k)];
        EXPECT_EQ(block[0], opposite[0]);
        EXPECT_EQ(block[1], opposite[2]);
        EXPECT_EQ(block[2], opposite[1]);
        EXPECT_EQ(block[3], opposite[3]);
      }
  // x . A y == y . A x for unit vectors, through the kernels.
  const auto image = [&](int i, int j) {
    GridVector x = A.vector(), out = A.vector();
    x.x()[A.place(i, j)] = 1;
    A.multiply(x, out);
    return out;
  };
  EXPECT_EQ(image(4, 4).x()[A.place(5, 5)], image(5, 5).x()[A.place(4, 4)]);
  EXPECT_EQ(image(16, 3).x()[A.place(15, 4)], image(15, 4).x()[A.place(16, 3)]);
}

TEST(Kernels, GoAlongAWay) {
  const StrainedFilm film;
  const FilmGrid& grid = film.energy.grid();
  const GridField u = grid.field(film.u);
  VertexVector gradient(film.u.size());
  for (std::size_t v = 0; v < gradient.size(); ++v) gradient[v] = Vec2(0.01 * double(v), 1);
  const GridField force = grid.field(gradient);
  const GridVector way = some_way(grid);
  GridField gone(grid.layout());
  const kernels::Table& table = kernels::best();
  const kernels::Stride stride = table.go(0, grid.layout().entries(), u, way, 0.7, force, gone);
  double slope = 0, longest = 0;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    const std::size_t at = grid.place(v);
    const Vec2 step = 0.7 * Vec2(way.x()[at], way.y()[at]);
    EXPECT_NEAR(gone.x[at], film.u[v].x() - step.x(), 1e-12);
    EXPECT_NEAR(gone.y[at], film.u[v].y() - step.y(), 1e-12);
    slope += gradient[v].dot(step);
    longest = std::max(longest, step.norm());
  }
  EXPECT_NEAR(stride.slope, slope, 1e-9 * double(film.u.size()));
  EXPECT_NEAR(std::sqrt(stride.largest_square), longest, 1e-12);
  EXPECT_NEAR(table.dot_field(0, grid.layout().entries(), force, way), slope / 0.7,
              1e-9 * double(film.u.size()));
}

}  // namespace
}  // namespace hydrodip
