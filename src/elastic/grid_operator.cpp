#include "elastic/grid_operator.h"

#include <cmath>
#include <cstdint>

#include "elastic/kernel_variants.h"

namespace hydrodip {

namespace {

constexpr int kPowerIterations = 12;

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
  s.stride = layout_.stride;
  return s;
}

void GridOperator::multiply(const GridVector& x, GridVector& out) const {
  for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels_.multiply(stencil(), rows(begin, end), x, out);
  });
}

void GridOperator::precondition(const GridVector& b, float weight, GridVector& out) const {
  for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels_.precondition(stencil(), rows(begin, end), b, weight, out);
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

}  // namespace hydrodip
