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
    ++factorizations_;
    factored_ = true;
    stale_ = false;
    fresh_ = true;
  }

  void precondition(const std::vector<std::uint8_t>& is_free, const VertexVector& r,
                    VertexVector& z) {
    const auto vertices = static_cast<Eigen::Index>(r.size());
    using Coordinate = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<2>>;
    parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        solution_[k] = cholesky_.solve(Coordinate(r.data()->data() + k, vertices));
    });
    for (std::size_t v = 0; v < r.size(); ++v)
      z[v] = is_free[v] ? Vec2(solution_[0][Eigen::Index(v)], solution_[1][Eigen::Index(v)])
                        : Vec2::Zero();
  }

  LinearSolveResult conjugate_gradients(const BlockMatrix& H,
                                        const std::vector<std::uint8_t>& is_free,
                                        const VertexVector& b, double relative_tolerance,
                                        VertexVector& x) {
    x.assign(b.size(), Vec2::Zero());
    VertexVector r = b, z(b.size()), Hp(b.size());
    for (std::size_t v = 0; v < b.size(); ++v)
      if (!is_free[v]) r[v].setZero();
    precondition(is_free, r, z);
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
      precondition(is_free, r, z);
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
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
  std::array<Eigen::VectorXd, 2> solution_;
  bool factored_ = false, stale_ = false, fresh_ = false;
  int iterations_when_fresh_ = 0;
  long factorizations_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_laplacian_solver() {
  return std::make_unique<LaplacianSolver>();
}

}  // namespace hydrodip
