// Multigrid's cycle: sweeps that keep their order, smoothing where it pays, and convergence
// wherever the right side lies.

#include "elastic/multigrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "elastic/active_part.h"

namespace hydrodip {
namespace {

TEST(GridLayout, SweepsEveryRowAfterItsNeighbours) {
  struct Sweep {
    int nx, ny, stages;
    std::ptrdiff_t begin, end;
  };
  for (const Sweep& s :
       {Sweep{125, 161, 4, 0, 161}, Sweep{125, 161, 3, 40, 120}, Sweep{1000, 500, 4, 100, 480},
        Sweep{125, 161, 4, 70, 70}, Sweep{10, 7, 4, 0, 7}, Sweep{2000, 3, 3, 0, 3}}) {
    const GridLayout layout(s.nx, s.ny);
    std::vector<std::atomic<int>> stages_done(std::size_t(s.ny));
    std::atomic<int> calls = 0, early = 0;
    layout.sweep(s.stages, s.begin, s.end, [&](int stage, std::ptrdiff_t row) {
      for (auto j = std::max<std::ptrdiff_t>(0, row - 1); j <= row + 1 && j < s.ny; ++j)
        if (stages_done[std::size_t(j)] < stage) ++early;
      if (stages_done[std::size_t(row)]++ != stage) ++early;
      ++calls;
    });
    EXPECT_EQ(early, 0);
    EXPECT_EQ(calls, s.ny * s.stages);
  }
}

// A membrane that is held at its rim, stiff in places.
GridOperator::Row membrane_row(double stiffness) {
  GridOperator::Row row{};
  for (std::size_t k = 0; k < 9; ++k) row[k] = {-float(stiffness), 0, 0, -float(stiffness)};
  row[4] = {8 * float(stiffness), 0, 0, 8 * float(stiffness)};
  return row;
}

void make_membrane(GridOperator& A) {
  for (int j = 1; j < A.ny() - 1; ++j)
    for (int i = 1; i < A.nx() - 1; ++i) A.set_row(i, j, membrane_row(1));
}

bool is_smoothed(const ActivePart& part, int i, int j) {
  const kernels::Part row = part.smoothed(j);
  return i >= row.group_begin * kernels::kLanes && i < row.group_end * kernels::kLanes;
}

TEST(ActivePart, HoldsWhatMovesAndWhatLiesAroundIt) {
  GridOperator A(125, 161);
  make_membrane(A);
  ActivePart part(A);
  GridVector b = A.vector();
  b.x()[A.place(60, 40)] = 1;
  b.y()[A.place(90, 70)] = -0.1F;
  b.x()[A.place(20, 150)] = 0.01F;  // far less than the others
  part.choose(A, b);
  for (const auto& [i, j] : {std::pair{60, 40}, {90, 70}})
    for (int dj = -8; dj <= 8; ++dj)
      for (int di = -16; di <= 16; ++di) EXPECT_TRUE(is_smoothed(part, i + di, j + dj));
  EXPECT_FALSE(is_smoothed(part, 20, 150));
  EXPECT_FALSE(is_smoothed(part, 10, 40));
  for (int j = 0; j < A.ny(); ++j) {
    if (is_smoothed(part, 60, j)) {
      EXPECT_TRUE(j >= part.row_begin() && j < part.row_end());
    }
    // Whatever one smoothed node reaches.
    for (int i = 0; i < A.nx(); ++i)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          if (i + di < 0 || i + di >= A.nx() || j + dj < 0 || j + dj >= A.ny()) continue;
          if (!is_smoothed(part, i, j)) continue;
          const kernels::Part reached = part.reached(j + dj);
          EXPECT_GE(i + di, reached.group_begin * kernels::kLanes);
          EXPECT_LT(i + di, reached.group_end * kernels::kLanes);
        }
  }
  for (int j = 0; j < A.ny(); ++j)
    for (int i = 0; i < A.nx(); ++i) b.x()[A.place(i, j)] = 1;
  part.choose(A, b);
  for (int j = 0; j < A.ny(); ++j) EXPECT_TRUE(part.whole(part.smoothed(j)));
}

// A node of soft film moves as far as one of hard film under a far smaller force.
TEST(ActivePart, AsksHowFarNodesMove) {
  GridOperator A(125, 161);
  make_membrane(A);
  for (int i = 30; i < 40; ++i) A.set_row(i, 20, membrane_row(600));
  ActivePart part(A);
  GridVector b = A.vector();
  b.x()[A.place(35, 20)] = 600;
  b.x()[A.place(100, 140)] = 1;
  part.choose(A, b);
  EXPECT_TRUE(is_smoothed(part, 35, 20));
  EXPECT_TRUE(is_smoothed(part, 100, 140));
  EXPECT_FALSE(is_smoothed(part, 35, 80));
}

double norm(const GridOperator& A, const GridVector& v) {
  double sum = 0;
  for (int j = 0; j < A.ny(); ++j)
    for (std::size_t n = A.place(0, j); n < A.place(A.nx(), j); ++n)
      sum += double(v.x()[n]) * double(v.x()[n]) + double(v.y()[n]) * double(v.y()[n]);
  return std::sqrt(sum);
}

// Whether the right side lies in one place, everywhere, or mostly in one place.
TEST(Multigrid, CyclesConvergeWhereverTheRightSideLies) {
  Multigrid grid(125, 161);
  GridOperator& A = grid.finest();
  make_membrane(A);
  grid.update(true);
  for (const double elsewhere : {0.0, 1.0, 0.02}) {
    GridVector b = A.vector(), x = A.vector(), Ax = A.vector(), rest = A.vector(),
               step = A.vector();
    for (int j = 1; j < A.ny() - 1; ++j)
      for (int i = 1; i < A.nx() - 1; ++i)
        b.x()[A.place(i, j)] = float(elsewhere * std::sin(i * j));
    for (int i = 50; i < 60; ++i) b.y()[A.place(i, 100)] = 1;
    rest = b;
    const double first = norm(A, b);
    for (int cycle = 1; cycle <= 6; ++cycle) {
      grid.cycle(rest, step);
      for (int j = 0; j < A.ny(); ++j)
        for (std::size_t n = A.place(0, j); n < A.place(A.nx(), j); ++n) {
          x.x()[n] += step.x()[n];
          x.y()[n] += step.y()[n];
        }
      A.multiply(x, Ax);
      for (int j = 0; j < A.ny(); ++j)
        for (std::size_t n = A.place(0, j); n < A.place(A.nx(), j); ++n) {
          rest.x()[n] = b.x()[n] - Ax.x()[n];
          rest.y()[n] = b.y()[n] - Ax.y()[n];
        }
      EXPECT_LT(norm(A, rest), first * std::pow(0.5, cycle)) << elsewhere << ", cycle " << cycle;
    }
    EXPECT_LT(norm(A, rest), 2e-3 * first) << elsewhere;
  }
}

}  // namespace
}  // namespace hydrodip
