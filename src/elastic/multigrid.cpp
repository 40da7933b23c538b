#include "elastic/multigrid.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"

namespace hydrodip {

namespace {

// The smoother damps errors with eigenvalues of D^-1 A above the largest over this.
constexpr double kSmoothedRange = 14;
constexpr double kEigenvalueMargin = 1.1;
// Of an operator that is a sum over cells, D^-1 A has no eigenvalue above the nodes in a cell.
constexpr double kWidest = 4;
constexpr double kWidening = 1.25;
constexpr int kPowerIterations = 12;
// Grids with at most this many inner nodes are solved directly.
constexpr std::size_t kCoarsestNodes = 12;

kernels::Transfer transfer(const GridOperator& fine, const GridOperator& coarse) {
  return {fine.layout().stride, coarse.layout().stride, fine.nx(), fine.ny(), coarse.nx(),
          fine.mask(),          coarse.mask()};
}

// Bilinear interpolation: weight of a coarse node for a fine one at this distance (fine cells).
float hat(int distance) { return distance == 0 ? 1.0F : 0.5F; }

}  // namespace

GridOperator::GridOperator(int nx, int ny)
    : layout_(nx, ny),
      kernels_(kernels::best()),
      mask_(layout_.entries()),
      entries_(kEntries * layout_.entries()) {}

void GridOperator::set_row(int i, int j, const Row& row) {
  const std::size_t at = place(i, j);
  const double xx = row[4][0], xy = 0.5 * (double(row[4][1]) + double(row[4][2])), yy = row[4][3];
  const double det = xx * yy - xy * xy;
  const bool usable = xx > 0 && yy > 0 && det > 1e-6 * xx * yy;
  mask_[at] = usable ? 1.0F : 0.0F;
  const auto set = [&](int e, double value) { entry(e)[at] = usable ? float(value) : 0.0F; };
  set(kOwn, xx);
  set(kOwn + 1, xy);
  set(kOwn + 2, yy);
  set(kInverse, yy / det);
  set(kInverse + 1, -xy / det);
  set(kInverse + 2, xx / det);
  for (int k = 0; k < kernels::kForward; ++k)
    for (int e = 0; e < 4; ++e)
      set(kForward + 4 * k + e, double(row[std::size_t(5 + k)][std::size_t(e)]));
}

GridOperator::Row GridOperator::row(int i, int j) const {
  const std::size_t at = place(i, j);
  Row row;
  row[4] = {entry(kOwn)[at], entry(kOwn + 1)[at], entry(kOwn + 1)[at], entry(kOwn + 2)[at]};
  const std::ptrdiff_t stride = layout_.stride, way[] = {1, stride - 1, stride, stride + 1};
  for (int k = 0; k < kernels::kForward; ++k) {
    const std::size_t behind = at - std::size_t(way[k]);
    const float* block[4];
    for (int e = 0; e < 4; ++e) block[e] = entry(kForward + 4 * k + e);
    row[std::size_t(5 + k)] = {block[0][at], block[1][at], block[2][at], block[3][at]};
    row[std::size_t(3 - k)] = {block[0][behind], block[2][behind], block[1][behind],
                               block[3][behind]};
  }
  return row;
}

kernels::Stencil GridOperator::stencil() const {
  kernels::Stencil s{};
  for (int e = 0; e < 3; ++e) {
    s.own[e] = entry(kOwn + e);
    s.inverse_own[e] = entry(kInverse + e);
  }
  for (int k = 0; k < kernels::kForward; ++k)
    for (int e = 0; e < 4; ++e) s.forward[k][e] = entry(kForward + 4 * k + e);
  s.mask = mask();
  s.groups = layout_.groups;
  s.stride = layout_.stride;
  return s;
}

void GridOperator::multiply(const GridVector& x, GridVector& out) const {
  for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels_.multiply(stencil(), begin, end, x, out);
  });
}

void GridOperator::residual(const GridVector& b, const GridVector& x, GridVector& r) const {
  for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels_.residual(stencil(), begin, end, b, x, r);
  });
}

void GridOperator::smooth(const GridVector& b, const GridVector& x, float weight,
                          GridVector& out) const {
  for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels_.smooth(stencil(), begin, end, b, x, weight, out);
  });
}

void GridOperator::precondition(const GridVector& b, float weight, GridVector& out) const {
  for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels_.precondition(stencil(), begin, end, b, weight, out);
  });
}

double GridOperator::largest_eigenvalue() const {
  GridVector x = vector(), Ax = vector();
  std::uint32_t noise = 1;
  for (int j = 0; j < ny(); ++j)
    for (int i = 0; i < nx(); ++i) {
      if (!is_free(i, j)) continue;
      for (float* component : {x.x(), x.y()}) {
        noise = noise * 1664525U + 1013904223U;
        component[place(i, j)] = float(noise >> 8) / float(1 << 24) - 0.5F;
      }
    }
  double norm = 0;
  for (int n = 0; n < kPowerIterations; ++n) {
    multiply(x, Ax);
    precondition(Ax, 1, x);
    double square = 0;
    for (int j = 0; j < ny(); ++j)
      for (std::size_t p = place(0, j); p < place(nx(), j); ++p)
        square += double(x.x()[p]) * x.x()[p] + double(x.y()[p]) * x.y()[p];
    norm = std::sqrt(square);
    if (!(norm > 0)) return 0;
    const auto scale = float(1 / norm);
    for (int j = 0; j < ny(); ++j)
      for (std::size_t p = place(0, j); p < place(nx(), j); ++p) {
        x.x()[p] *= scale;
        x.y()[p] *= scale;
      }
  }
  return norm;
}

Multigrid::Level::Level(int nx, int ny)
    : A(nx, ny), b(A.vector()), x(A.vector()), other(A.vector()), touched(A.nodes(), 0) {}

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
  std::array<std::array<std::array<float, 4>, 5>, 5> reach{};
  const auto inside = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < fine.nx() && j < fine.ny() && fine.is_free(i, j);
  };
  for (int dj = -1; dj <= 1; ++dj)
    for (int di = -1; di <= 1; ++di) {
      const int i = 2 * I + di, j = 2 * J + dj;
      if (!inside(i, j)) continue;
      const GridOperator::Row row = fine.row(i, j);
      const float weight = hat(di) * hat(dj);
      for (int k = 0; k < 9; ++k) {
        const int ci = di + k % 3 - 1, cj = dj + k / 3 - 1;
        if (!inside(2 * I + ci, 2 * J + cj)) continue;
        auto& sum = reach[std::size_t(cj + 2)][std::size_t(ci + 2)];
        for (std::size_t e = 0; e < 4; ++e) sum[e] += weight * row[std::size_t(k)][e];
      }
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

// Two Jacobi steps whose weights are the roots of the Chebyshev polynomial over the range to damp.
void Multigrid::choose_weights(Level& level) {
  const double largest = level.largest;
  if (!(largest > 0)) return;
  const double middle = 0.5 * largest * (1 + 1 / kSmoothedRange);
  const double radius = 0.5 * largest * (1 - 1 / kSmoothedRange);
  level.weight[0] = float(1 / (middle + radius * std::sqrt(0.5)));
  level.weight[1] = float(1 / (middle - radius * std::sqrt(0.5)));
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

// b = P^T r.
void Multigrid::restrict_to(const Level& fine, const GridVector& r, Level& coarse) const {
  coarse.A.for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels::best().restrict_rows(transfer(fine.A, coarse.A), begin, end, r, coarse.b);
  });
}

// x += P e.
void Multigrid::prolong_and_add(const Level& coarse, const Level& fine, GridVector& x) const {
  fine.A.for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels::best().prolong_rows(transfer(fine.A, coarse.A), begin, end, coarse.x, x);
  });
}

void Multigrid::cycle(const GridVector& b, GridVector& x) { cycle(0, b, x); }

void Multigrid::cycle(std::size_t l, const GridVector& b, GridVector& x) {
  if (l + 1 == levels_.size()) {
    solve_coarsest(b, x);
    return;
  }
  Level &level = levels_[l], &coarse = levels_[l + 1];
  level.A.precondition(b, level.weight[0], level.other);
  level.A.smooth(b, level.other, level.weight[1], x);
  level.A.residual(b, x, level.other);
  restrict_to(level, level.other, coarse);
  cycle(l + 1, coarse.b, coarse.x);
  prolong_and_add(coarse, level, x);
  level.A.smooth(b, x, level.weight[1], level.other);
  level.A.smooth(b, level.other, level.weight[0], x);
}

}  // namespace hydrodip
