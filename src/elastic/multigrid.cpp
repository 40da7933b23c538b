#include "elastic/multigrid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"

namespace hydrodip {

namespace {

// The smoother damps errors with eigenvalues of D^-1 A above the largest over `range`, in so many
// steps before the coarser grid and as many after it. An even number: two vectors take turns.
struct Smoothing {
  int steps;
  double range;
};
constexpr Smoothing kShort = {2, 14};
// Where hard ink and soft film take turns every few cells, coarse grids are stiffer than the film:
// smoothing them longer saves a fifth of the iterations and costs little. Small grids cost no less
// for being small, and gain nothing.
constexpr Smoothing kLong = {4, 20};
constexpr std::size_t kSmallGrid = 1000;
constexpr double kEigenvalueMargin = 1.1;
// Of an operator that is a sum over cells, D^-1 A has no eigenvalue above the nodes in a cell.
constexpr double kWidest = 4;
constexpr double kWidening = 1.25;
// Grids with at most this many inner nodes are solved directly.
constexpr std::size_t kCoarsestNodes = 12;

kernels::Transfer transfer(const GridOperator& fine, const GridOperator& coarse) {
  return {fine.layout().stride, coarse.layout().stride, fine.nx(), fine.ny(), coarse.nx(),
          fine.mask(),          coarse.mask()};
}

// Bilinear interpolation: weight of a coarse node for a fine one at this distance (fine cells).
float hat(int distance) { return distance == 0 ? 1.0F : 0.5F; }

void clear_row(const GridLayout& layout, std::ptrdiff_t j, GridVector& v) {
  for (float* values : {v.x(), v.y()})
    std::fill_n(values + layout.place(0, int(j)), layout.stride - kernels::kLanes, 0.0F);
}

void copy_row(const GridLayout& layout, std::ptrdiff_t j, const GridVector& from, GridVector& to) {
  const std::size_t first = layout.place(0, int(j));
  std::copy_n(from.x() + first, layout.stride - kernels::kLanes, to.x() + first);
  std::copy_n(from.y() + first, layout.stride - kernels::kLanes, to.y() + first);
}

}  // namespace

Multigrid::Level::Level(int nx, int ny)
    : A(nx, ny),
      b(A.vector()),
      x(A.vector()),
      other(A.vector()),
      touched(A.nodes(), 0),
      active(A) {}

Multigrid::Multigrid(int nx, int ny) {
  levels_.emplace_back(nx, ny);
  while (nx > 3 && ny > 3 && std::size_t(nx - 2) * std::size_t(ny - 2) > kCoarsestNodes) {
    nx = nx / 2 + 1;
    ny = ny / 2 + 1;
    levels_.emplace_back(nx, ny);
  }
}

void Multigrid::touch(int i, int j) { touch(levels_.front(), i, j); }

void Multigrid::touch(Level& level, int i, int j) {
  const std::size_t n = level.A.node(i, j);
  if (level.touched[n]) return;
  level.touched[n] = 1;
  level.to_do.push_back(static_cast<std::int32_t>(n));
}

void Multigrid::update(bool all) {
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    Level &fine = levels_[l], &coarse = levels_[l + 1];
    if (all) {
      for (int J = 0; J < coarse.A.ny(); ++J)
        for (int I = 0; I < coarse.A.nx(); ++I) touch(coarse, I, J);
    } else {
      for (std::int32_t n : fine.to_do) {
        const int i = n % fine.A.nx(), j = n / fine.A.nx();
        for (int J = j / 2; J <= (j + 1) / 2; ++J)
          for (int I = i / 2; I <= (i + 1) / 2; ++I) touch(coarse, I, J);
      }
    }
    coarsen(fine, coarse);
  }
  if (all)
    for (Level& level : levels_) {
      level.largest = kEigenvalueMargin * level.A.largest_eigenvalue();
      choose_weights(level);
    }
  factor_coarsest();
  for (Level& level : levels_) {
    for (std::int32_t n : level.to_do) level.touched[std::size_t(n)] = 0;
    level.to_do.clear();
  }
}

void Multigrid::coarsen(const Level& fine, Level& coarse) const {
  constexpr std::size_t kRowsPerTask = 16;
  parallel_for(coarse.to_do.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const int I = coarse.to_do[n] % coarse.A.nx(), J = coarse.to_do[n] / coarse.A.nx();
      coarse.A.set_row(I, J, galerkin_row(fine.A, I, J));
    }
  });
}

// Row (I, J) of P^T A P: the rows of the nine fine nodes that the coarse one is interpolated to,
// gathered over the 5 x 5 fine nodes that they reach, then handed to the coarse nodes of those.
GridOperator::Row Multigrid::galerkin_row(const GridOperator& fine, int I, int J) const {
  const auto mask = [&](int i, int j) {
    const bool inside = i >= 0 && j >= 0 && i < fine.nx() && j < fine.ny();
    return inside ? fine.mask()[fine.place(i, j)] : 0.0F;
  };
  std::array<std::array<std::array<float, 4>, 5>, 5> reach{};
  for (int dj = -1; dj <= 1; ++dj)
    for (int di = -1; di <= 1; ++di) {
      const int i = 2 * I + di, j = 2 * J + dj;
      if (!(mask(i, j) > 0)) continue;
      const GridOperator::Row row = fine.row(i, j);
      const float weight = hat(di) * hat(dj);
      for (std::size_t k = 0; k < 9; ++k) {
        auto& sum = reach[std::size_t(dj + 1) + k / 3][std::size_t(di + 1) + k % 3];
        for (std::size_t e = 0; e < 4; ++e) sum[e] += weight * row[k][e];
      }
    }
  for (int dj = -2; dj <= 2; ++dj)
    for (int di = -2; di <= 2; ++di) {
      const float free = mask(2 * I + di, 2 * J + dj);
      for (float& e : reach[std::size_t(dj + 2)][std::size_t(di + 2)]) e *= free;
    }
  // Only the node's own block and those of the nodes that follow are kept.
  GridOperator::Row coarse{};
  for (int k = 4; k < 9; ++k) {
    const int ci = 2 * (k % 3 - 1), cj = 2 * (k / 3 - 1);
    auto& out = coarse[std::size_t(k)];
    for (int dj = std::max(-1, -2 - cj); dj <= std::min(1, 2 - cj); ++dj)
      for (int di = std::max(-1, -2 - ci); di <= std::min(1, 2 - ci); ++di) {
        const auto& sum = reach[std::size_t(cj + dj + 2)][std::size_t(ci + di + 2)];
        const float weight = hat(di) * hat(dj);
        for (std::size_t e = 0; e < 4; ++e) out[e] += weight * sum[e];
      }
  }
  return coarse;
}

// Jacobi steps whose weights are the roots of the Chebyshev polynomial over the range to damp.
void Multigrid::choose_weights(Level& level) const {
  const double largest = level.largest;
  if (!(largest > 0)) return;
  const bool longer = &level != &levels_.front() && level.A.nodes() >= kSmallGrid;
  const Smoothing& smoothing = longer ? kLong : kShort;
  const double middle = 0.5 * largest * (1 + 1 / smoothing.range);
  const double radius = 0.5 * largest * (1 - 1 / smoothing.range);
  level.weights.clear();
  for (int k = 0; k < smoothing.steps; ++k)
    level.weights.push_back(
        float(1 / (middle + radius * std::cos(std::numbers::pi * (k + 0.5) / smoothing.steps))));
}

bool Multigrid::widen() {
  bool wider = false;
  for (Level& level : levels_) {
    const double largest = std::min(kWidest, kWidening * level.largest);
    wider |= largest > level.largest;
    level.largest = std::max(level.largest, largest);
    choose_weights(level);
  }
  return wider;
}

void Multigrid::factor_coarsest() {
  const GridOperator& A = levels_.back().A;
  coarsest_place_.clear();
  std::vector<std::int32_t> number(A.nodes(), -1);
  std::vector<std::array<int, 2>> node;
  for (int j = 0; j < A.ny(); ++j)
    for (int i = 0; i < A.nx(); ++i) {
      if (!A.is_free(i, j)) continue;
      number[A.node(i, j)] = static_cast<std::int32_t>(node.size());
      node.push_back({i, j});
      coarsest_place_.push_back(A.place(i, j));
    }
  const auto n = static_cast<Eigen::Index>(2 * node.size());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t a = 0; a < node.size(); ++a) {
    const GridOperator::Row row = A.row(node[a][0], node[a][1]);
    for (int k = 0; k < 9; ++k) {
      const int i = node[a][0] + k % 3 - 1, j = node[a][1] + k / 3 - 1;
      if (i < 0 || j < 0 || i >= A.nx() || j >= A.ny() || !A.is_free(i, j)) continue;
      const auto b = Eigen::Index(number[A.node(i, j)]);
      for (Eigen::Index e = 0; e < 4; ++e)
        dense(2 * Eigen::Index(a) + e / 2, 2 * b + e % 2) = row[std::size_t(k)][std::size_t(e)];
    }
  }
  coarsest_.compute(dense);
  // An operator that is not definite there still has to be preconditioned by one that is.
  for (double shift = 1e-3; coarsest_.info() != Eigen::Success && shift < 1e3; shift *= 10)
    coarsest_.compute(dense +
                      shift * dense.diagonal().maxCoeff() * Eigen::MatrixXd::Identity(n, n));
}

void Multigrid::solve_coarsest(const GridVector& b, GridVector& x) const {
  x.set_zero();
  const auto nodes = static_cast<Eigen::Index>(coarsest_place_.size());
  if (nodes == 0) return;
  Eigen::VectorXd y(2 * nodes);
  for (Eigen::Index k = 0; k < nodes; ++k) {
    const std::size_t place = coarsest_place_[std::size_t(k)];
    y.segment<2>(2 * k) << b.x()[place], b.y()[place];
  }
  coarsest_.solveInPlace(y);
  for (Eigen::Index k = 0; k < nodes; ++k) {
    const std::size_t place = coarsest_place_[std::size_t(k)];
    x.x()[place] = float(y[2 * k]);
    x.y()[place] = float(y[2 * k + 1]);
  }
}

// Smooths x from zero. What is left, restricted, is the coarse right side: b = P^T r.
void Multigrid::go_down(Level& level, const GridVector& b, GridVector& x, Level& coarse) const {
  const kernels::Table& run = kernels::best();
  const GridLayout& layout = level.A.layout();
  const kernels::Stencil A = level.A.stencil();
  const kernels::Transfer between = transfer(level.A, coarse.A);
  const ActivePart& active = level.active;
  const int steps = int(level.weights.size());
  GridVector* const turns[2] = {&level.other, &x};  // whose row the steps write in turn
  GridVector& rest = level.other;
  layout.sweep(steps + 2, active.row_begin(), active.row_end(), [&](int pass, std::ptrdiff_t j) {
    const kernels::Part smoothed = active.smoothed(j), reached = active.reached(j);
    if (pass < steps) {
      GridVector &from = *turns[1 - pass % 2], &to = *turns[pass % 2];
      const float weight = level.weights[std::size_t(pass)];
      if (pass < 2 && !active.whole(smoothed)) clear_row(layout, j, to);
      if (pass == 0)
        run.precondition(A, smoothed, b, weight, to);
      else
        run.smooth(A, smoothed, b, from, weight, to);
    } else if (pass == steps) {
      if (!active.whole(reached)) copy_row(layout, j, b, rest);
      run.residual(A, reached, b, x, rest);
    } else {
      // The coarse row that lies on this one; after the last, one may lie half a cell beyond.
      const bool beyond = j + 1 == level.A.ny() && j % 2 == 1;
      run.restrict_rows(between, (j + 1) / 2, j / 2 + (beyond ? 2 : 1), rest, coarse.b);
    }
  });
}

// x += P e, smoothed.
void Multigrid::come_up(const Level& coarse, Level& level, const GridVector& b,
                        GridVector& x) const {
  const kernels::Table& run = kernels::best();
  const GridLayout& layout = level.A.layout();
  const kernels::Stencil A = level.A.stencil();
  const kernels::Transfer between = transfer(level.A, coarse.A);
  const ActivePart& active = level.active;
  const int steps = int(level.weights.size());
  GridVector* const turns[2] = {&x, &level.other};
  layout.sweep(steps + 1, active.row_begin(), active.row_end(), [&](int pass, std::ptrdiff_t j) {
    if (pass == 0) return run.prolong_rows(between, j, j + 1, coarse.x, x);
    const kernels::Part smoothed = active.smoothed(j);
    if (pass == 1 && !active.whole(smoothed)) copy_row(layout, j, x, level.other);
    const GridVector& from = *turns[(pass - 1) % 2];
    run.smooth(A, smoothed, b, from, level.weights[std::size_t(steps - pass)], *turns[pass % 2]);
  });
}

void Multigrid::cycle(const GridVector& b, GridVector& x) { cycle(0, b, x); }

void Multigrid::cycle(std::size_t l, const GridVector& b, GridVector& x) {
  if (l + 1 == levels_.size()) {
    solve_coarsest(b, x);
    return;
  }
  Level &level = levels_[l], &coarse = levels_[l + 1];
  level.active.choose(level.A, b);
  go_down(level, b, x, coarse);
  cycle(l + 1, coarse.b, coarse.x);
  come_up(coarse, level, b, x);
}

}  // namespace hydrodip
