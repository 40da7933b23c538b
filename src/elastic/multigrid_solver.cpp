#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"
#include "elastic/linear_solver.h"
#include "elastic/multigrid.h"

namespace hydrodip {

namespace {

constexpr std::size_t kRowsPerTask = 512;
// A triangle's part of the operator is kept until it has changed by this much, relatively.
constexpr double kOperatorTolerance = 0.05;
// Vertices that have moved by less than this share of a cell have changed it by less than that.
constexpr double kStillShare = kOperatorTolerance / 4;

class MultigridSolver : public LinearSolver {
 public:
  explicit MultigridSolver(const FilmMesh& mesh)
      : mesh_(mesh),
        grid_(mesh.nx, mesh.ny),
        row_sum_(std::size_t(mesh.ny)),
        column_(mesh.u.size()),
        line_(mesh.u.size()),
        place_(mesh.u.size()),
        r_(grid_.finest().vector()),
        r_before_(r_),
        z_(r_),
        p_(r_),
        Ap_(r_) {
    for (int j = 0; j < mesh.ny; ++j)
      for (int i = 0; i < mesh.nx; ++i) {
        const std::int32_t v = mesh.vertex_at[grid_.finest().node(i, j)];
        if (v < 0) continue;
        column_[std::size_t(v)] = i;
        line_[std::size_t(v)] = j;
        place_[std::size_t(v)] = static_cast<std::int32_t>(grid_.finest().place(i, j));
      }
  }

  void update(const FilmEnergy& energy, const VertexVector& u,
              const std::vector<std::uint8_t>& is_free, bool definite, double moved_mm) override {
    const bool all = is_free_.empty();
    if (definite == definite_ && moved_mm < kStillShare * mesh_.cell_mm) return;
    if (all) kept_.resize(mesh_.triangles.size());
    find_changes(energy, u, all);
    if (definite != definite_) find_indefinite(energy);
    definite_ = definite;
    linearize(energy, u);
    touch_masked(is_free, all);
    compute_rows(energy);
    grid_.update(all);
    restart_ = true;
  }

  bool direction(const VertexVector& gradient, VertexVector& step) override {
    r_.swap(r_before_);
    set_right_side(gradient);
    const float length = turn();
    if (!(length >= 0)) return false;
    step.resize(gradient.size());
    parallel_for(step.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const auto place = std::size_t(place_[v]);
        step[v] = double(length) * Vec2(p_.x()[place], p_.y()[place]);
      }
    });
    return true;
  }

 private:
  // What the operator was computed from, per triangle.
  struct Kept {
    std::vector<float> gradient[2][2], area, cosine, sine, turning;
    void resize(std::size_t n) {
      for (auto& corner : gradient)
        for (auto& component : corner) component.assign(n, 0);
      for (auto* values : {&area, &cosine, &sine, &turning}) values->assign(n, 0);
    }
    kernels::Linearization view() const {
      return {{{gradient[0][0].data(), gradient[0][1].data()},
               {gradient[1][0].data(), gradient[1][1].data()}},
              area.data(),
              cosine.data(),
              sine.data(),
              turning.data()};
    }
  };

  void find_changes(const FilmEnergy& energy, const VertexVector& u, bool all) {
    const std::size_t triangles = mesh_.triangles.size();
    differs_.assign(triangles, 1);
    if (all) return;
    parallel_for(triangles, kElementGrain, [&](std::size_t begin, std::size_t end) {
      kernels_.changed(energy.elements(), begin, end, u.data()->data(), kept_.view(),
                       kOperatorTolerance, differs_.data());
    });
  }

  // Triangles whose parts depend on definite_.
  void find_indefinite(const FilmEnergy& energy) {
    for (std::size_t t = 0; t < differs_.size(); ++t)
      differs_[t] |= std::int64_t(double(kept_.turning[t]) < -energy.material(t).mu);
  }

  void linearize(const FilmEnergy& energy, const VertexVector& u) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!differs_[t]) continue;
      const RestTriangle rest = energy.rest(t);
      const Triangle& v = mesh_.triangles[t];
      const Polar p = polar(deformation_gradient(rest, u[std::size_t(v[0])], u[std::size_t(v[1])],
                                                 u[std::size_t(v[2])]));
      for (Eigen::Index k = 0; k < 2; ++k)
        for (Eigen::Index c = 0; c < 2; ++c)
          kept_.gradient[k][c][t] = float(rest.gradient(k + 1, c));
      kept_.area[t] = float(rest.area);
      kept_.cosine[t] = float(p.cosine);
      kept_.sine[t] = float(p.sine);
      kept_.turning[t] = float(turning_stiffness(p, energy.material(t), false));
      for (std::int32_t corner : v) touch(std::size_t(corner));
    }
  }

  void touch(std::size_t v) { grid_.touch(column_[v], line_[v]); }

  // A vertex that is held no longer moves its neighbours.
  void touch_masked(const std::vector<std::uint8_t>& is_free, bool all) {
    for (std::size_t v = 0; v < is_free.size(); ++v) {
      if (!all && is_free[v] == is_free_[v]) continue;
      for (int j = line_[v] - 1; j <= line_[v] + 1; ++j)
        for (int i = column_[v] - 1; i <= column_[v] + 1; ++i)
          if (i >= 0 && j >= 0 && i < mesh_.nx && j < mesh_.ny) grid_.touch(i, j);
    }
    is_free_ = is_free;
  }

  void compute_rows(const FilmEnergy& energy) {
    const std::vector<std::int32_t>& nodes = grid_.touched();
    std::vector<GridOperator::Row> rows(nodes.size());
    parallel_for(nodes.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const std::int32_t v = mesh_.vertex_at[std::size_t(nodes[n])];
        if (v >= 0 && is_free_[std::size_t(v)]) rows[n] = row_of(energy, std::size_t(v));
      }
    });
    for (std::size_t n = 0; n < nodes.size(); ++n)
      grid_.finest().set_row(nodes[n] % mesh_.nx, nodes[n] / mesh_.nx, rows[n]);
  }

  // FilmEnergy::hessian's row of a vertex, from what was kept of its triangles.
  GridOperator::Row row_of(const FilmEnergy& energy, std::size_t v) const {
    GridOperator::Row row{};
    for (auto n = std::size_t(mesh_.incident_begin[v]);
         n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
      const auto t = std::size_t(mesh_.incident[n]);
      const float area = kept_.area[t];
      if (!(area > 0)) continue;
      add_triangle(energy.material(t), t, v, row);
    }
    return row;
  }

  void add_triangle(const Lame& material, std::size_t t, std::size_t v,
                    GridOperator::Row& row) const {
    const auto mu = float(material.mu), lambda = float(material.lambda);
    const float area = kept_.area[t], cosine = kept_.cosine[t], sine = kept_.sine[t];
    const float turning = area * (definite_ ? std::max(kept_.turning[t], -mu) : kept_.turning[t]);
    float gx[3], gy[3];
    for (std::size_t k = 1; k < 3; ++k) {
      gx[k] = kept_.gradient[k - 1][0][t];
      gy[k] = kept_.gradient[k - 1][1][t];
    }
    gx[0] = -gx[1] - gx[2];
    gy[0] = -gy[1] - gy[2];
    const Triangle& corners = mesh_.triangles[t];
    const std::size_t a = std::size_t(corners[0]) == v ? 0 : std::size_t(corners[1]) == v ? 1 : 2;
    const auto rotated_x = [&](std::size_t k) { return cosine * gx[k] - sine * gy[k]; };
    const auto rotated_y = [&](std::size_t k) { return sine * gx[k] + cosine * gy[k]; };
    // R g, and R J g at right angles to it.
    const float rx = rotated_x(a), ry = rotated_y(a);
    for (std::size_t b = 0; b < 3; ++b) {
      const auto w = std::size_t(corners[b]);
      const float sx = rotated_x(b), sy = rotated_y(b);
      const float stretch = 2 * mu * area * (gx[a] * gx[b] + gy[a] * gy[b]);
      const float dilating = area * lambda;
      auto& block = row[std::size_t(3 * (line_[w] - line_[v] + 1) + column_[w] - column_[v] + 1)];
      block[0] += stretch + dilating * rx * sx + turning * ry * sy;
      block[1] += dilating * rx * sy - turning * ry * sx;
      block[2] += dilating * ry * sx - turning * rx * sy;
      block[3] += stretch + dilating * ry * sy + turning * rx * sx;
    }
  }

  void set_right_side(const VertexVector& b) {
    const float* mask = grid_.finest().mask();
    parallel_for(b.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const auto place = std::size_t(place_[v]);
        r_.x()[place] = mask[place] * float(b[v].x());
        r_.y()[place] = mask[place] * float(b[v].y());
      }
    });
  }

  // Sum over the grid's rows, in their order, of body(first, last entry of the row).
  template <typename Body>
  double sum_over_rows(const Body& body) {
    const GridOperator& A = grid_.finest();
    A.for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto j = begin; j < end; ++j)
        row_sum_[std::size_t(j)] =
            body(A.place(0, int(j)), A.place(0, int(j) + 1) - kernels::kLanes);
    });
    return std::accumulate(row_sum_.begin(), row_sum_.end(), 0.0);
  }

  double dot(const GridVector& a, const GridVector& b) {
    return sum_over_rows(
        [&](std::size_t first, std::size_t last) { return kernels_.dot(first, last, a, b); });
  }

  // Turns p_ into the next conjugate direction, from the gradients r_ and r_before_. Returns how
  // far to go along it; below 0 if the operator is not definite.
  float turn() {
    grid_.cycle(r_, z_);
    const double rz = dot(r_, z_);
    if (rz < 0) return -1;
    const double bend = restart_ ? 0 : std::max(0.0, (rz - dot(r_before_, z_)) / rz_before_);
    rz_before_ = rz;
    restart_ = !(rz > 0);
    if (bend > 0)
      add_to_direction(float(bend));
    else
      p_ = z_;
    grid_.finest().multiply(p_, Ap_);
    const double curvature = dot(p_, Ap_);
    if (!(curvature > 0)) return rz > 0 ? -1.0F : 0.0F;
    return float(dot(r_, p_) / curvature);
  }

  // p_ = z_ + bend p_.
  void add_to_direction(float bend) {
    const GridOperator& A = grid_.finest();
    A.for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      kernels_.scale_and_add(A.place(0, int(begin)), A.place(0, int(end)) - kernels::kLanes, p_,
                             bend, z_);
    });
  }

  const FilmMesh& mesh_;
  const kernels::Table& kernels_ = kernels::best();
  Multigrid grid_;
  std::vector<double> row_sum_;
  // Of each vertex: on the grid, and in vectors over it.
  std::vector<std::int32_t> column_, line_, place_;
  std::vector<std::uint8_t> is_free_;
  std::vector<std::int64_t> differs_;
  Kept kept_;
  bool definite_ = false, restart_ = true;
  // Gradient and the one before, preconditioned gradient, direction, operator times direction.
  GridVector r_, r_before_, z_, p_, Ap_;
  double rz_before_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_multigrid_solver(const FilmMesh& mesh) {
  return std::make_unique<MultigridSolver>(mesh);
}

}  // namespace hydrodip
