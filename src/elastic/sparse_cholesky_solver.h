// Newton's steps by one of Eigen's sparse Cholesky classes: the reference of the tests, and what
// the benchmarks compare with.
#pragma once

#include <Eigen/SparseCore>
#include <algorithm>

#include "elastic/linear_solver.h"

namespace hydrodip {

// Cholesky: an Eigen class that reads the lower triangle. Symbolic analysis once, one numeric
// factorisation per update().
template <typename Cholesky>
class SparseCholeskySolver : public LinearSolver {
 public:
  void update(const FilmEnergy& energy, const GridField& u,
              const std::vector<std::uint8_t>& is_free, bool definite, double) override {
    grid_ = &energy.grid();
    VertexVector by_vertex;
    grid_->to_vertices(u, by_vertex);
    energy.hessian(by_vertex, definite, H_);
    is_free_ = is_free;
    const bool first = entries_.empty();
    if (first) way_ = GridVector(grid_->layout());
    if (first) build_pattern();
    set_values();
    if (first) cholesky_.analyzePattern(matrix_);
    cholesky_.factorize(matrix_);
  }

  std::optional<SearchDirection> direction(const GridField& gradient) override {
    if (cholesky_.info() != Eigen::Success) return std::nullopt;
    Eigen::VectorXd right(2 * Eigen::Index(is_free_.size()));
    for (std::size_t v = 0; v < is_free_.size(); ++v) {
      const std::size_t place = grid_->place(v);
      right.segment<2>(2 * Eigen::Index(v)) =
          is_free_[v] ? Vec2(gradient.x[place], gradient.y[place]) : Vec2(0, 0);
    }
    const Eigen::VectorXd solution = cholesky_.solve(right);
    if (!solution.allFinite()) return std::nullopt;
    // In single precision its longest move still fits, however far the film is from rest.
    const double length = std::max(solution.cwiseAbs().maxCoeff(), 1e-30);
    for (std::size_t v = 0; v < is_free_.size(); ++v) {
      way_.x()[grid_->place(v)] = float(solution[2 * Eigen::Index(v)] / length);
      way_.y()[grid_->place(v)] = float(solution[2 * Eigen::Index(v) + 1] / length);
    }
    return SearchDirection{way_, length};
  }

 private:
  // Where an entry of the matrix comes from: block (v, w) of H_, and inside it.
  struct Entry {
    std::int32_t block, row, column;
    bool diagonal;
    std::int32_t v, w;
  };

  // Of scalars, the lower triangle only, all vertices: the analysis stays valid when some are held.
  void build_pattern() {
    const auto vertices = std::int32_t(H_.row_begin.size()) - 1;
    std::vector<int> begin = {0}, rows;
    for (std::int32_t v = 0; v < vertices; ++v)
      for (std::int32_t c = 0; c < 2; ++c) {
        for (auto s = H_.row_begin[std::size_t(v)]; s < H_.row_begin[std::size_t(v) + 1]; ++s) {
          const std::int32_t w = H_.column[std::size_t(s)];
          for (std::int32_t r = 0; r < 2; ++r) {
            if (2 * w + r < 2 * v + c) continue;
            rows.push_back(2 * w + r);
            // H is symmetric: entry (w r, v c) is entry (c, r) of block (v, w).
            entries_.push_back({s, c, r, 2 * w + r == 2 * v + c, v, w});
          }
        }
        begin.push_back(int(rows.size()));
      }
    matrix_.resize(2 * vertices, 2 * vertices);
    matrix_.resizeNonZeros(Eigen::Index(rows.size()));
    std::copy(begin.begin(), begin.end(), matrix_.outerIndexPtr());
    std::copy(rows.begin(), rows.end(), matrix_.innerIndexPtr());
  }

  // Held vertices keep a unit diagonal.
  void set_values() {
    for (std::size_t k = 0; k < entries_.size(); ++k) {
      const Entry& e = entries_[k];
      const bool both = is_free_[std::size_t(e.v)] && is_free_[std::size_t(e.w)];
      matrix_.valuePtr()[k] =
          both ? H_.block[std::size_t(e.block)](e.row, e.column) : (e.diagonal ? 1.0 : 0.0);
    }
  }

  const FilmGrid* grid_ = nullptr;
  BlockMatrix H_;
  GridVector way_;
  std::vector<std::uint8_t> is_free_;
  std::vector<Entry> entries_;
  Eigen::SparseMatrix<double> matrix_;
  Cholesky cholesky_;
};

}  // namespace hydrodip
