#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "elastic/linear_solver.h"

namespace hydrodip {

namespace {

constexpr int kMaxIterations = 400;
// The factor is renewed when a solve needs this many iterations more than right after renewal.
constexpr int kIterationSlack = 3;
constexpr std::size_t kGrain = 4096;

double dot(const VertexVector& a, const VertexVector& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += a[v].x() * b[v].x() + a[v].y() * b[v].y();
  return sum;
}

void multiply(const BlockMatrix& H, const std::vector<std::uint8_t>& is_free, const VertexVector& x,
              VertexVector& out) {
  parallel_for(x.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec2 sum = Vec2::Zero();
      if (is_free[v])
        for (auto s = std::size_t(H.row_begin[v]); s < std::size_t(H.row_begin[v + 1]); ++s)
          sum += H.block[s] * x[std::size_t(H.column[s])];
      out[v] = sum;
    }
  });
}

// The factor L D L^T of a permuted matrix in single precision, for both coordinates at once: a
// preconditioner need not be exact, and the solve is bound by memory.
class SinglePrecisionFactor {
 public:
  using Cholesky = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

  void copy_from(const Cholesky& cholesky) {
    const auto& L = cholesky.matrixL().nestedExpression();
    const auto n = L.cols();
    begin_.assign(L.outerIndexPtr(), L.outerIndexPtr() + n + 1);
    row_.assign(L.innerIndexPtr(), L.innerIndexPtr() + begin_.back());
    value_.assign(L.valuePtr(), L.valuePtr() + begin_.back());
    const auto& D = cholesky.vectorD();
    inverse_d_.resize(std::size_t(n));
    for (Eigen::Index i = 0; i < n; ++i) inverse_d_[std::size_t(i)] = float(1 / D[i]);
    const auto& P = cholesky.permutationP().indices();
    place_.assign(P.data(), P.data() + n);
    x_.resize(std::size_t(n));
  }

  // z = (L D L^T)^-1 r on the free vertices, zero elsewhere.
  void solve(const std::vector<std::uint8_t>& is_free, const VertexVector& r, VertexVector& z) {
    const std::size_t n = x_.size();
    for (std::size_t v = 0; v < n; ++v)
      x_[std::size_t(place_[v])] = {float(r[v].x()), float(r[v].y())};
    for (std::size_t j = 0; j < n; ++j) {
      const Pair xj = x_[j];
      for (auto k = std::size_t(begin_[j]); k < std::size_t(begin_[j + 1]); ++k) {
        Pair& xi = x_[std::size_t(row_[k])];
        xi.x -= value_[k] * xj.x;
        xi.y -= value_[k] * xj.y;
      }
    }
    for (std::size_t j = n; j-- > 0;) {
      Pair xj{x_[j].x * inverse_d_[j], x_[j].y * inverse_d_[j]};
      for (auto k = std::size_t(begin_[j]); k < std::size_t(begin_[j + 1]); ++k) {
        const Pair& xi = x_[std::size_t(row_[k])];
        xj.x -= value_[k] * xi.x;
        xj.y -= value_[k] * xi.y;
      }
      x_[j] = xj;
    }
    for (std::size_t v = 0; v < n; ++v) {
      const Pair& xv = x_[std::size_t(place_[v])];
      z[v] = is_free[v] ? Vec2(xv.x, xv.y) : Vec2::Zero();
    }
  }

 private:
  struct Pair {
    float x, y;
  };
  std::vector<std::int32_t> begin_, row_, place_;
  std::vector<float> value_, inverse_d_;
  std::vector<Pair> x_;
};

class LaplacianSolver : public LinearSolver {
 public:
  LinearSolveResult solve(const FilmEnergy& energy, const BlockMatrix& H,
                          const std::vector<std::uint8_t>& is_free, const VertexVector& b,
                          double relative_tolerance, VertexVector& x) override {
    if (!factored_ || stale_) renew(energy, is_free);
    LinearSolveResult result = conjugate_gradients(H, is_free, b, relative_tolerance, x);
    if (!result.converged && !fresh_) {
      renew(energy, is_free);
      result = conjugate_gradients(H, is_free, b, relative_tolerance, x);
    }
    if (fresh_) iterations_when_fresh_ = result.iterations;
    stale_ = result.iterations > iterations_when_fresh_ + kIterationSlack;
    fresh_ = false;
    return result;
  }

  long factorizations() const override { return factorizations_; }

 private:
  void renew(const FilmEnergy& energy, const std::vector<std::uint8_t>& is_free) {
    const BlockMatrix& pattern = energy.pattern();
    std::vector<double> values;
    energy.laplacian(values);
    const auto vertices = static_cast<Eigen::Index>(is_free.size());
    if (matrix_.rows() != vertices) {
      matrix_.resize(vertices, vertices);
      matrix_.resizeNonZeros(static_cast<Eigen::Index>(pattern.column.size()));
      std::copy(pattern.row_begin.begin(), pattern.row_begin.end(), matrix_.outerIndexPtr());
      std::copy(pattern.column.begin(), pattern.column.end(), matrix_.innerIndexPtr());
    }
    for (std::size_t v = 0; v < is_free.size(); ++v)
      for (auto s = std::size_t(pattern.row_begin[v]); s < std::size_t(pattern.row_begin[v + 1]);
           ++s) {
        const auto w = std::size_t(pattern.column[s]);
        double value = is_free[v] && is_free[w] ? values[s] : 0.0;
        // A vertex without any film around it has an empty row: hold it.
        if (v == w && !(value > 0)) value = 1;
        matrix_.valuePtr()[s] = value;
      }
    if (!factored_) cholesky_.analyzePattern(matrix_);
    cholesky_.factorize(matrix_);
    factor_.copy_from(cholesky_);
    ++factorizations_;
    factored_ = true;
    stale_ = false;
    fresh_ = true;
  }

  LinearSolveResult conjugate_gradients(const BlockMatrix& H,
                                        const std::vector<std::uint8_t>& is_free,
                                        const VertexVector& b, double relative_tolerance,
                                        VertexVector& x) {
    x.assign(b.size(), Vec2::Zero());
    VertexVector r = b, z(b.size()), Hp(b.size());
    for (std::size_t v = 0; v < b.size(); ++v)
      if (!is_free[v]) r[v].setZero();
    factor_.solve(is_free, r, z);
    VertexVector p = z;
    double rz = dot(r, z);
    const double target = rz * relative_tolerance * relative_tolerance;
    LinearSolveResult result;
    if (!(rz > 0)) return {0, rz == 0};
    while (result.iterations < kMaxIterations) {
      ++result.iterations;
      multiply(H, is_free, p, Hp);
      const double curvature = dot(p, Hp);
      if (!(curvature > 0)) return result;
      const double alpha = rz / curvature;
      for (std::size_t v = 0; v < b.size(); ++v) {
        x[v] += alpha * p[v];
        r[v] -= alpha * Hp[v];
      }
      factor_.solve(is_free, r, z);
      const double rz_next = dot(r, z);
      if (!std::isfinite(rz_next)) return result;
      if (rz_next <= target) {
        result.converged = true;
        return result;
      }
      const double beta = rz_next / rz;
      rz = rz_next;
      for (std::size_t v = 0; v < b.size(); ++v) p[v] = z[v] + beta * p[v];
    }
    return result;
  }

  Eigen::SparseMatrix<double> matrix_;
  SinglePrecisionFactor::Cholesky cholesky_;
  SinglePrecisionFactor factor_;
  bool factored_ = false, stale_ = false, fresh_ = false;
  int iterations_when_fresh_ = 0;
  long factorizations_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_laplacian_solver() {
  return std::make_unique<LaplacianSolver>();
}

}  // namespace hydrodip
