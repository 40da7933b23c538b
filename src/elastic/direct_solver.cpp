#include <Eigen/SparseCholesky>

#include "elastic/linear_solver.h"

namespace hydrodip {

namespace {

class DirectSolver : public LinearSolver {
 public:
  void update(const FilmEnergy& energy, const VertexVector& u,
              const std::vector<std::uint8_t>& is_free, bool definite, double) override {
    energy.hessian(u, definite, H_);
    is_free_ = is_free;
    assemble(H_, is_free);
    if (!analyzed_) {
      cholesky_.analyzePattern(matrix_);
      analyzed_ = true;
    }
    cholesky_.factorize(matrix_);
    ++factorizations_;
  }

  LinearSolveResult solve(const VertexVector& b, double, VertexVector& x) override {
    x.assign(b.size(), Vec2::Zero());
    if (cholesky_.info() != Eigen::Success) return {0, false};
    Eigen::VectorXd rhs(2 * static_cast<Eigen::Index>(b.size()));
    for (std::size_t v = 0; v < b.size(); ++v)
      rhs.segment<2>(2 * Eigen::Index(v)) = is_free_[v] ? b[v] : Vec2::Zero();
    const Eigen::VectorXd solution = cholesky_.solve(rhs);
    for (std::size_t v = 0; v < b.size(); ++v) x[v] = solution.segment<2>(2 * Eigen::Index(v));
    return {0, solution.allFinite()};
  }

  long factorizations() const override { return factorizations_; }

 private:
  // Keeps the full pattern, with unit rows for fixed vertices, so that the analysis stays valid.
  void assemble(const BlockMatrix& H, const std::vector<std::uint8_t>& is_free) {
    const auto vertices = static_cast<Eigen::Index>(is_free.size());
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(4 * H.block.size());
    for (Eigen::Index v = 0; v < vertices; ++v)
      for (auto s = H.row_begin[std::size_t(v)]; s < H.row_begin[std::size_t(v) + 1]; ++s) {
        const Eigen::Index w = H.column[std::size_t(s)];
        const bool both = is_free[std::size_t(v)] && is_free[std::size_t(w)];
        for (Eigen::Index i = 0; i < 2; ++i)
          for (Eigen::Index j = 0; j < 2; ++j) {
            double value = both ? H.block[std::size_t(s)](i, j) : 0.0;
            if (!both && v == w && i == j) value = 1;
            entries.emplace_back(2 * v + i, 2 * w + j, value);
          }
      }
    matrix_.resize(2 * vertices, 2 * vertices);
    matrix_.setFromTriplets(entries.begin(), entries.end());
  }

  BlockMatrix H_;
  std::vector<std::uint8_t> is_free_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
  bool analyzed_ = false;
  long factorizations_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver() { return std::make_unique<DirectSolver>(); }

}  // namespace hydrodip
