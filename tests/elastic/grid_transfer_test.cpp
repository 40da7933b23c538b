// Multigrid's parts by themselves: interpolation and its transpose, a hierarchy that is kept up to
// date, a cycle that is symmetric; and relaxation's last step.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastic/grid_operator.h"
#include "elastic/kernel_variants.h"
#include "elastic/multigrid.h"
#include "elastic/relaxation.h"

namespace hydrodip {
namespace {

GridOperator::Row even_row(float stiffness) {
  GridOperator::Row row{};
  for (auto& block : row) block = {-stiffness, 0, 0, -stiffness};
  row[4] = {8 * stiffness, 0, 0, 8 * stiffness};
  return row;
}

// Free inside, held at the rim.
void make_even(GridOperator& A, float stiffness = 1) {
  for (int j = 1; j < A.ny() - 1; ++j)
    for (int i = 1; i < A.nx() - 1; ++i) A.set_row(i, j, even_row(stiffness));
}

void fill(const GridOperator& A, unsigned seed, GridVector& v) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int j = 0; j < A.ny(); ++j)
    for (int i = 0; i < A.nx(); ++i) {
      if (!A.is_free(i, j)) continue;
      v.x()[A.place(i, j)] = unit(generator);
      v.y()[A.place(i, j)] = unit(generator);
    }
}

double dot(const GridOperator& A, const GridVector& a, const GridVector& b) {
  double sum = 0;
  for (int j = 0; j < A.ny(); ++j)
    for (int i = 0; i < A.nx(); ++i) {
      const std::size_t n = A.place(i, j);
      sum += double(a.x()[n]) * double(b.x()[n]) + double(a.y()[n]) * double(b.y()[n]);
    }
  return sum;
}

struct TwoGrids {
  GridOperator fine, coarse;
  TwoGrids(int nx, int ny) : fine(nx, ny), coarse(nx / 2 + 1, ny / 2 + 1) {
    make_even(fine);
    make_even(coarse);
  }
  kernels::Transfer between() const {
    return {fine.layout().stride, coarse.layout().stride, fine.nx(), fine.ny(), coarse.nx(),
            fine.mask(),          coarse.mask()};
  }
  void prolong(const GridVector& e, GridVector& x) const {
    kernels::best().prolong_rows(between(), 0, fine.ny(), e, x);
  }
  void restrict_to(const GridVector& r, GridVector& b) const {
    kernels::best().restrict_rows(between(), 0, coarse.ny(), r, b);
  }
};

// <P e, r> = <e, P^T r>, on grids of even and odd size.
TEST(GridTransfer, RestrictionIsTheTransposeOfInterpolation) {
  for (const auto& [nx, ny] : {std::pair{33, 21}, {34, 22}, {125, 40}}) {
    const TwoGrids grids(nx, ny);
    GridVector e = grids.coarse.vector(), b = grids.coarse.vector();
    GridVector r = grids.fine.vector(), x = grids.fine.vector();
    fill(grids.coarse, 1, e);
    fill(grids.fine, 2, r);
    grids.prolong(e, x);
    grids.restrict_to(r, b);
    const double size = std::sqrt(dot(grids.coarse, e, e) * dot(grids.fine, r, r));
    EXPECT_NEAR(dot(grids.fine, x, r), dot(grids.coarse, e, b), 1e-5 * size) << nx << " x " << ny;
    EXPECT_GT(std::abs(dot(grids.fine, x, r)), 1e-3 * size);
  }
}

// What is linear on the coarse grid is the same linear function on the fine one, and is added.
TEST(GridTransfer, InterpolationIsExactForLinearFunctions) {
  const TwoGrids grids(33, 21);
  GridVector e = grids.coarse.vector(), x = grids.fine.vector();
  for (int j = 0; j < grids.coarse.ny(); ++j)
    for (int i = 0; i < grids.coarse.nx(); ++i) {
      e.x()[grids.coarse.place(i, j)] = float(1 + 2 * i - 3 * j);
      e.y()[grids.coarse.place(i, j)] = float(2 - i + 4 * j);
    }
  for (int j = 1; j < grids.fine.ny() - 1; ++j)
    for (int i = 1; i < grids.fine.nx() - 1; ++i) x.x()[grids.fine.place(i, j)] = 100;
  grids.prolong(e, x);
  for (int j = 1; j < grids.fine.ny() - 1; ++j)
    for (int i = 1; i < grids.fine.nx() - 1; ++i) {
      EXPECT_FLOAT_EQ(x.x()[grids.fine.place(i, j)], float(100 + 1 + i - 1.5 * j));
      EXPECT_FLOAT_EQ(x.y()[grids.fine.place(i, j)], float(2 - 0.5 * i + 2 * j));
    }
  EXPECT_EQ(x.x()[grids.fine.place(0, 5)], 0);  // held
}

// How much of a random right side is left after so many cycles.
double left_after(Multigrid& grid, int cycles) {
  const GridOperator& A = grid.finest();
  GridVector b = A.vector(), x = A.vector(), Ax = A.vector(), rest = A.vector(), step = A.vector();
  fill(A, 5, b);
  rest = b;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    grid.cycle(rest, step);
    for (int j = 0; j < A.ny(); ++j)
      for (int i = 0; i < A.nx(); ++i) {
        const std::size_t n = A.place(i, j);
        x.x()[n] += step.x()[n];
        x.y()[n] += step.y()[n];
      }
    A.multiply(x, Ax);
    for (int j = 0; j < A.ny(); ++j)
      for (int i = 0; i < A.nx(); ++i) {
        const std::size_t n = A.place(i, j);
        rest.x()[n] = b.x()[n] - Ax.x()[n];
        rest.y()[n] = b.y()[n] - Ax.y()[n];
      }
  }
  return std::sqrt(dot(A, rest, rest) / dot(A, b, b));
}

// <M^-1 a, b> = <a, M^-1 b>.
TEST(Multigrid, CyclesAreSymmetric) {
  Multigrid grid(65, 49);
  GridOperator& A = grid.finest();
  make_even(A);
  grid.update(true);
  GridVector a = A.vector(), b = A.vector(), Ma = A.vector(), Mb = A.vector();
  fill(A, 1, a);
  fill(A, 2, b);
  grid.cycle(a, Ma);
  grid.cycle(b, Mb);
  EXPECT_NEAR(dot(A, Ma, b), dot(A, a, Mb), 1e-4 * std::sqrt(dot(A, Ma, Ma) * dot(A, b, b)));
  EXPECT_GT(dot(A, Ma, a), 0);
}

// A membrane that is `stiffness` times as stiff in a block; `told`: says which rows are new.
void set_block(Multigrid& grid, float stiffness, bool told) {
  GridOperator& A = grid.finest();
  const auto at = [&](int i, int j) {
    return i >= 20 && i <= 40 && j >= 14 && j <= 29 ? stiffness : 1.0F;
  };
  for (int j = 1; j < A.ny() - 1; ++j)
    for (int i = 1; i < A.nx() - 1; ++i) {
      GridOperator::Row row{};
      float all = 0;
      for (int k = 0; k < 9; ++k) {
        if (k == 4) continue;
        const float pull = std::min(at(i, j), at(i + k % 3 - 1, j + k / 3 - 1));
        row[std::size_t(k)] = {-pull, 0, 0, -pull};
        all += pull;
      }
      row[4] = {all, 0, 0, all};
      A.set_row(i, j, row);
      const bool is_new = i >= 19 && i <= 41 && j >= 13 && j <= 30;
      if (told && is_new) grid.touch(i, j);
    }
}

// Film in a block grows a hundred times as stiff or as soft: told of its nodes alone, the hierarchy
// is the one that is made anew.
TEST(Multigrid, IsRefreshedWhereItsFinestGridChanges) {
  for (const float stiffness : {100.0F, 0.01F}) {
    Multigrid anew(65, 49);
    set_block(anew, stiffness, false);
    anew.update(true);
    Multigrid told(65, 49);
    set_block(told, stiffness, false);
    told.update(true);
    set_block(told, 1, true);
    told.update(false);
    EXPECT_TRUE(told.touched().empty());
    EXPECT_LT(left_after(told, 8), 0.02);
    // Nor is it another than one that is told of all nodes.
    Multigrid told_all(65, 49);
    set_block(told_all, stiffness, false);
    told_all.update(true);
    set_block(told_all, 1, false);
    for (int j = 0; j < 49; ++j)
      for (int i = 0; i < 65; ++i) told_all.touch(i, j);
    told_all.update(false);
    EXPECT_EQ(left_after(told, 8), left_after(told_all, 8)) << stiffness;
    set_block(told, stiffness, true);
    told.update(false);
    EXPECT_EQ(left_after(told, 8), left_after(anew, 8)) << stiffness;
    EXPECT_LT(left_after(anew, 8), 0.1) << stiffness;
    // One that was not told is another.
    Multigrid stale(65, 49);
    set_block(stale, 1, false);
    stale.update(true);
    set_block(stale, stiffness, false);
    EXPECT_NE(left_after(stale, 8), left_after(anew, 8)) << stiffness;
  }
}

// A step that counts as the last one is taken whole, and must still turn nothing over: soft film
// between the rim and a vertex whose stiff film wants it beyond the rim.
TEST(RelaxationLastStep, TurnsNoFilmOverHoweverLooseTheTolerance) {
  const FilmMesh mesh = make_film_mesh(
      {.width_mm = 30, .height_mm = 30, .margin_mm = 5, .elements = 8, .grading = 1});
  const auto centre = std::size_t(mesh.vertex_at[4]);
  VertexVector wanted = mesh.u;
  wanted[centre] = Vec2(14, 0);  // the film ends at 10
  std::vector<double> modulus;
  std::vector<RestTriangle> rest;
  for (const Triangle& v : mesh.triangles) {
    const auto triangle_in = [&](const VertexVector& at) {
      return rest_triangle(at[std::size_t(v[0])], at[std::size_t(v[1])], at[std::size_t(v[2])]);
    };
    const bool stiff = triangle_in(wanted).area > 0;
    rest.push_back(triangle_in(stiff ? wanted : mesh.u));
    modulus.push_back(stiff ? 1000 : 1);
  }
  FilmEnergy energy(mesh, modulus, 0);
  energy.set_rest(rest);
  std::vector<std::uint8_t> is_free(mesh.u.size(), 0);
  is_free[centre] = 1;
  const auto solver = make_direct_solver();
  VertexVector u = mesh.u;
  Relaxation(energy, *solver).run(is_free, {.tolerance_mm = 100}, u);
  EXPECT_FALSE(energy.any_inverted(energy.grid().field(u)));
  EXPECT_LE(energy.value(energy.grid().field(u)), energy.value(energy.grid().field(mesh.u)));
}

}  // namespace
}  // namespace hydrodip
