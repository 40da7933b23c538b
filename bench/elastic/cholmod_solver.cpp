#include "elastic/cholmod_solver.h"

#include <Eigen/CholmodSupport>

namespace hydrodip {

namespace {

class CholmodSolver : public LinearSolver {
 public:
  void update(const FilmEnergy& energy, const VertexVector& u,
              const std::vector<std::uint8_t>& is_free, bool definite, double) override {
    energy.hessian(u, definite, H_);
    is_free_ = is_free;
    if (pattern_.empty()) {
      build_pattern();
      set_values();
      cholesky_.analyzePattern(matrix_);
    } else {
      set_values();
    }
    cholesky_.factorize(matrix_);
    ++factorizations_;
  }

  LinearSolveResult solve(const VertexVector& b, double, VertexVector& x) override {
    x.assign(b.size(), Vec2::Zero());
    if (cholesky_.info() != Eigen::Success) return {0, false};
    Eigen::VectorXd right(2 * Eigen::Index(b.size()));
    for (std::size_t v = 0; v < b.size(); ++v)
      right.segment<2>(2 * Eigen::Index(v)) = is_free_[v] ? b[v] : Vec2::Zero();
    const Eigen::VectorXd solution = cholesky_.solve(right);
    for (std::size_t v = 0; v < b.size(); ++v) x[v] = solution.segment<2>(2 * Eigen::Index(v));
    return {0, solution.allFinite()};
  }

  long factorizations() const override { return factorizations_; }

 private:
  // Lower triangle only, columns of scalars; fixed vertices keep a unit diagonal.
  struct Entry {
    std::int32_t block, row, column;  // of H_, and inside the block
    bool diagonal;
    std::int32_t v, w;
  };

  void build_pattern() {
    const auto n = std::int32_t(H_.row_begin.size()) - 1;
    std::vector<int> begin = {0}, rows;
    for (std::int32_t v = 0; v < n; ++v)
      for (std::int32_t c = 0; c < 2; ++c) {
        for (auto s = H_.row_begin[std::size_t(v)]; s < H_.row_begin[std::size_t(v) + 1]; ++s) {
          const std::int32_t w = H_.column[std::size_t(s)];
          for (std::int32_t r = 0; r < 2; ++r) {
            if (2 * w + r < 2 * v + c) continue;
            rows.push_back(2 * w + r);
            // H is symmetric: entry (w r, v c) is entry (c, r) of block (v, w).
            pattern_.push_back({s, c, r, 2 * w + r == 2 * v + c, v, w});
          }
        }
        begin.push_back(int(rows.size()));
      }
    matrix_.resize(2 * n, 2 * n);
    matrix_.resizeNonZeros(Eigen::Index(rows.size()));
    std::copy(begin.begin(), begin.end(), matrix_.outerIndexPtr());
    std::copy(rows.begin(), rows.end(), matrix_.innerIndexPtr());
  }

  void set_values() {
    for (std::size_t k = 0; k < pattern_.size(); ++k) {
      const Entry& e = pattern_[k];
      const bool both = is_free_[std::size_t(e.v)] && is_free_[std::size_t(e.w)];
      matrix_.valuePtr()[k] =
          both ? H_.block[std::size_t(e.block)](e.row, e.column) : (e.diagonal ? 1.0 : 0.0);
    }
  }

  BlockMatrix H_;
  std::vector<std::uint8_t> is_free_;
  std::vector<Entry> pattern_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky_;
  long factorizations_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_cholmod_solver() { return std::make_unique<CholmodSolver>(); }

}  // namespace hydrodip
