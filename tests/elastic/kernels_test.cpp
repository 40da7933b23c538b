// The inner loops: the same bytes from every instruction set, and the numbers of the plain
// formulas.

#include "elastic/kernels.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <vector>

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
    std::vector<std::uint8_t> film(mesh.triangles.size(), 1);
    for (std::size_t t = 0; t < film.size(); t += 17) film[t] = 0;
    energy.set_flat_rest(place, film);
    for (std::uint8_t rim : mesh.on_rim) is_free.push_back(!rim);
  }
};

// Everything that a table computes from one film, one after the other.
std::vector<double> results_of(const kernels::Table& table) {
  const StrainedFilm film;
  const std::size_t n = film.mesh.triangles.size();
  std::vector<double> results;
  std::vector<std::vector<double>> force(4, std::vector<double>(n));
  double* const out[2][2] = {{force[0].data(), force[1].data()},
                             {force[2].data(), force[3].data()}};
  results.push_back(double(table.forces(film.energy.elements(), 0, n, film.u.data()->data(), out)));
  for (const auto& f : force) results.insert(results.end(), f.begin(), f.end());
  results.push_back(double(table.turned_over(film.energy.elements(), 0, n, film.u.data()->data())));
  std::vector<std::int64_t> flags(n);
  table.overstretched(film.energy.elements(), 0, n, film.u.data()->data(), 1.2, flags.data());
  results.insert(results.end(), flags.begin(), flags.end());
  std::vector<double> area(n);
  const std::vector<std::uint8_t> present(n, 1);
  table.rest_shapes(film.energy.elements(), 0, n, film.u.data()->data(), present.data(), out,
                    area.data());
  for (const auto& g : force) results.insert(results.end(), g.begin(), g.end());
  results.insert(results.end(), area.begin(), area.end());
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
  VertexVector gradient;
  film.energy.gradient(film.u, film.is_free, gradient);
  constexpr double kStep = 1e-6;
  for (std::size_t v = 0; v < film.u.size(); v += 7)
    for (Eigen::Index c = 0; c < 2; ++c) {
      VertexVector ahead = film.u, behind = film.u;
      ahead[v][c] += kStep;
      behind[v][c] -= kStep;
      const double slope = (film.energy.value(ahead) - film.energy.value(behind)) / (2 * kStep);
      EXPECT_NEAR(gradient[v][c], film.is_free[v] ? slope : 0, 1e-6);
    }
}

TEST(Kernels, OverstretchedIsWhereThePrincipalStretchPassesTheLimit) {
  const StrainedFilm film;
  for (const double limit : {1.05, 1.2, 1.6}) {
    std::vector<std::int64_t> flags;
    film.energy.overstretched(film.u, limit, flags);
    std::size_t over = 0;
    for (std::size_t t = 0; t < flags.size(); ++t) {
      const Triangle& v = film.mesh.triangles[t];
      const RestTriangle rest = film.energy.rest(t);
      const bool expected =
          rest.area > 0 && largest_stretch(deformation_gradient(rest, film.u[std::size_t(v[0])],
                                                                film.u[std::size_t(v[1])],
                                                                film.u[std::size_t(v[2])])) > limit;
      EXPECT_EQ(flags[t] != 0, expected) << t;
      over += expected;
    }
    EXPECT_GT(over, 0U);
    EXPECT_LT(over, flags.size());
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

}  // namespace
}  // namespace hydrodip
