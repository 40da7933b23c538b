#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"
#include "elastic/law_tangents.h"
#include "elastic/linear_solver.h"
#include "elastic/multigrid.h"

namespace hydrodip {

namespace {

constexpr std::size_t kRowsPerTask = 32;
// A triangle's part of the operator is kept until it has changed by this much, relatively.
constexpr double kOperatorTolerance = 0.05;
// Vertices that have moved by less than this share of a cell have changed it by less than that.
constexpr double kStillShare = kOperatorTolerance / 4;

// Rows of cells in which nothing had changed are looked at again this many updates later.
constexpr int kLookAgain = 8;

// A step by the operator's diagonal alone may be this much too long.
constexpr double kWidestStep = 4;

class MultigridSolver : public LinearSolver {
 public:
  explicit MultigridSolver(const FilmMesh& mesh)
      : mesh_(mesh),
        film_(mesh),
        grid_(mesh.nx, mesh.ny),
        row_sums_(std::size_t(mesh.ny)),
        r_(film_.layout()),
        r_before_(r_),
        z_(r_),
        p_(r_),
        Ap_(r_) {
    kept_.resize(film_.elements());
    look_in_.resize(std::size_t(mesh.ny), 0);
  }

  void update(const FilmEnergy& energy, const GridField& u,
              const std::vector<std::uint8_t>& is_free, bool definite, double moved_mm) override {
    const bool all = is_free_.empty();
    if (definite == definite_ && moved_mm < kStillShare * mesh_.cell_mm) return;
    const bool turned = definite != definite_;
    definite_ = definite;
    touch_masked(is_free, all);
    if (energy.law())
      linearize_by_law(energy, u, turned);
    else
      linearize(energy, u, turned, all);
    compute_rows(energy);
    grid_.update(all);
    // Directions stay conjugate enough while it is the same film that moves.
    if (moved_mm >= kAnyChange) restart_ = true;
  }

  std::optional<SearchDirection> direction(const GridField& gradient) override {
    r_.swap(r_before_);
    set_right_side(gradient);
    const float length = turn();
    if (!(length >= 0)) return std::nullopt;
    return SearchDirection{p_, double(length)};
  }

 private:
  // What the operator was computed from, per element.
  struct Kept {
    GridArray<float> gradient[2][2], area, cosine, sine, turning;
    void resize(std::size_t n) {
      for (auto& corner : gradient)
        for (auto& component : corner) component = GridArray<float>(n);
      for (auto* values : {&area, &cosine, &sine, &turning}) *values = GridArray<float>(n);
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

  // Where the Hessian differs from what the operator was computed with, or where definite_, which
  // has `turned`, makes a difference.
  void linearize(const FilmEnergy& energy, const GridField& u, bool turned, bool all) {
    const kernels::Elements elements = energy.elements();
    differs_.resize(film_.elements(), 0);
    std::vector<std::vector<std::int32_t>> changed(std::size_t(mesh_.ny));  // by row of cells
    film_.layout().for_rows(mesh_.ny - 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto row = begin; row < end; ++row) {
        int& wait = look_in_[std::size_t(row)];
        if (!all && !turned && --wait > 0) continue;
        const std::int64_t count = kernels_.changed(elements, row, row + 1, u, kept_.view(),
                                                    kOperatorTolerance, differs_.data());
        // Not all of them in the same update.
        wait = count > 0 ? 0 : kLookAgain - (all || turned ? int(row) % kLookAgain : 0);
        if (count == 0 && !turned && !all) continue;
        for (const std::ptrdiff_t half : {std::ptrdiff_t(0), elements.upper}) {
          const auto first = film_.layout().place(0, int(row)) + std::size_t(half);
          for (std::size_t e = first; e < first + std::size_t(mesh_.nx) - 1; ++e) {
            const bool indefinite = turned && double(kept_.turning[e]) < -elements.mu[e];
            if (!differs_[e] && !indefinite && !all) continue;
            const std::int32_t t = film_.triangle(e);
            if (t < 0) continue;
            linearize(energy, u, std::size_t(t));
            changed[std::size_t(row)].push_back(t);
          }
        }
      }
    });
    for (const auto& row : changed)
      for (const std::int32_t t : row)
        for (const std::int32_t corner : mesh_.triangles[std::size_t(t)])
          touch(std::size_t(corner));
  }

  void linearize_by_law(const FilmEnergy& energy, const GridField& u, bool turned) {
    const double tolerance = turned ? 0 : kOperatorTolerance;
    for (const std::int32_t t : by_law_.update(energy, mesh_, u, definite_, tolerance))
      for (const std::int32_t corner : mesh_.triangles[std::size_t(t)]) touch(std::size_t(corner));
  }

  void linearize(const FilmEnergy& energy, const GridField& u, std::size_t t) {
    const std::size_t e = film_.element(t);
    const RestTriangle rest = energy.rest(t);
    const std::array<Vec2, 3> at = film_.corners(mesh_.triangles[t], u);
    const Polar p = polar(deformation_gradient(rest, at[0], at[1], at[2]));
    const kernels::Elements elements = energy.elements();
    for (int k = 0; k < 2; ++k)
      for (int c = 0; c < 2; ++c) kept_.gradient[k][c][e] = float(elements.gradient[k][c][e]);
    kept_.area[e] = float(rest.area);
    kept_.cosine[e] = float(p.cosine);
    kept_.sine[e] = float(p.sine);
    kept_.turning[e] = float(turning_stiffness(p, energy.material(t), false));
  }

  void touch(std::size_t v) { grid_.touch(film_.node(v)[0], film_.node(v)[1]); }

  // A vertex that is held no longer moves its neighbours.
  void touch_masked(const std::vector<std::uint8_t>& is_free, bool all) {
    constexpr std::size_t kAtOnce = 64;
    for (std::size_t v = 0; v < is_free.size(); ++v) {
      if (!all && v % kAtOnce == 0 && v + kAtOnce <= is_free.size() &&
          std::memcmp(&is_free[v], &is_free_[v], kAtOnce) == 0) {
        v += kAtOnce - 1;
        continue;
      }
      if (!all && is_free[v] == is_free_[v]) continue;
      const auto [column, line] = film_.node(v);
      for (int j = std::max(0, line - 2); j <= std::min(line + 1, mesh_.ny - 1); ++j)
        look_in_[std::size_t(j)] = 0;
      for (int j = line - 1; j <= line + 1; ++j)
        for (int i = column - 1; i <= column + 1; ++i)
          if (i >= 0 && j >= 0 && i < mesh_.nx && j < mesh_.ny) grid_.touch(i, j);
    }
    is_free_ = is_free;
  }

  void compute_rows(const FilmEnergy& energy) {
    const std::vector<std::int32_t>& nodes = grid_.touched();
    parallel_for(nodes.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const std::int32_t v = mesh_.vertex_at[std::size_t(nodes[n])];
        GridOperator::Row row{};
        if (v >= 0 && is_free_[std::size_t(v)]) row = row_of(energy, std::size_t(v));
        grid_.finest().set_row(nodes[n] % mesh_.nx, nodes[n] / mesh_.nx, row);
      }
    });
  }

  // FilmEnergy::hessian's row of a vertex, from what was kept of its triangles.
  GridOperator::Row row_of(const FilmEnergy& energy, std::size_t v) const {
    GridOperator::Row row{};
    for (auto n = std::size_t(mesh_.incident_begin[v]);
         n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
      const auto t = std::size_t(mesh_.incident[n]);
      if (energy.law())
        add_by_law(t, v, row);
      else if (kept_.area[film_.element(t)] > 0)
        add_triangle(energy.material(t), t, v, row);
    }
    return row;
  }

  void add_by_law(std::size_t t, std::size_t v, GridOperator::Row& row) const {
    const Triangle& corners = mesh_.triangles[t];
    const std::size_t a = std::size_t(corners[0]) == v ? 0 : std::size_t(corners[1]) == v ? 1 : 2;
    for (std::size_t b = 0; b < 3; ++b) {
      const auto &here = film_.node(v), &there = film_.node(std::size_t(corners[b]));
      auto& block = row[std::size_t(3 * (there[1] - here[1] + 1) + there[0] - here[0] + 1)];
      const LawTangents::Block& part = by_law_.block(t, a, b);
      for (std::size_t e = 0; e < 4; ++e) block[e] += part[e];
    }
  }

  void add_triangle(const Lame& material, std::size_t t, std::size_t v,
                    GridOperator::Row& row) const {
    const std::size_t e = film_.element(t);
    const auto mu = float(material.mu), lambda = float(material.lambda);
    const float area = kept_.area[e], cosine = kept_.cosine[e], sine = kept_.sine[e];
    const float turning = area * (definite_ ? std::max(kept_.turning[e], -mu) : kept_.turning[e]);
    // Of the triangle's own corners.
    const auto first = std::size_t(film_.first_corner(t));
    float gx[3], gy[3];
    for (std::size_t k = 1; k < 3; ++k) {
      gx[(first + k) % 3] = kept_.gradient[k - 1][0][e];
      gy[(first + k) % 3] = kept_.gradient[k - 1][1][e];
    }
    gx[first] = -kept_.gradient[0][0][e] - kept_.gradient[1][0][e];
    gy[first] = -kept_.gradient[0][1][e] - kept_.gradient[1][1][e];
    const Triangle& corners = mesh_.triangles[t];
    const std::size_t a = std::size_t(corners[0]) == v ? 0 : std::size_t(corners[1]) == v ? 1 : 2;
    const auto rotated_x = [&](std::size_t k) { return cosine * gx[k] - sine * gy[k]; };
    const auto rotated_y = [&](std::size_t k) { return sine * gx[k] + cosine * gy[k]; };
    // R g, and R J g at right angles to it.
    const float rx = rotated_x(a), ry = rotated_y(a);
    for (std::size_t b = 0; b < 3; ++b) {
      const auto &here = film_.node(v), &there = film_.node(std::size_t(corners[b]));
      const float sx = rotated_x(b), sy = rotated_y(b);
      const float stretch = 2 * mu * area * (gx[a] * gx[b] + gy[a] * gy[b]);
      const float dilating = area * lambda;
      auto& block = row[std::size_t(3 * (there[1] - here[1] + 1) + there[0] - here[0] + 1)];
      block[0] += stretch + dilating * rx * sx + turning * ry * sy;
      block[1] += dilating * rx * sy - turning * ry * sx;
      block[2] += dilating * ry * sx - turning * rx * sy;
      block[3] += stretch + dilating * ry * sy + turning * rx * sx;
    }
  }

  void set_right_side(const GridField& b) {
    const GridLayout& layout = film_.layout();
    grid_.finest().for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const float* mask = grid_.finest().mask();
      const double *bx = b.x.data(), *by = b.y.data();
      float *x = r_.x(), *y = r_.y();
      for (auto n = layout.place(0, int(begin)); n < layout.place(0, int(end)); ++n) {
        x[n] = mask[n] * float(bx[n]);
        y[n] = mask[n] * float(by[n]);
      }
    });
  }

  // a . b and a . c, summed over the grid's rows in their order.
  std::array<double, 2> dots(const GridVector& a, const GridVector& b, const GridVector& c) {
    const GridLayout& layout = film_.layout();
    grid_.finest().for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto j = begin; j < end; ++j) {
        const std::size_t first = layout.place(0, int(j));
        const std::size_t last = layout.place(0, int(j) + 1) - kernels::kLanes;
        row_sums_[std::size_t(j)] = {kernels_.dot(first, last, a, b),
                                     kernels_.dot(first, last, a, c)};
      }
    });
    std::array<double, 2> sums{};
    for (const auto& row : row_sums_)
      for (std::size_t k = 0; k < 2; ++k) sums[k] += row[k];
    return sums;
  }

  // z_ from r_. Returns its products with r_ and r_before_.
  std::array<double, 2> precondition() {
    while (true) {
      grid_.cycle(r_, z_);
      const std::array<double, 2> products = dots(z_, r_, r_before_);
      // Torn film can be stiffer in places than any was at first.
      if (!(products[0] < 0) || !definite_ || !grid_.widen()) return products;
      restart_ = true;
    }
  }

  // Turns p_ into the next conjugate direction, from the gradients r_ and r_before_. Returns how
  // far to go along it; below 0 if the operator is not definite.
  float turn() {
    const auto [rz, rz_between] = precondition();
    if (!(rz >= 0)) return definite_ ? plainly() : -1;
    const double bend = restart_ ? 0 : std::max(0.0, (rz - rz_between) / rz_before_);
    rz_before_ = rz;
    restart_ = !(rz > 0);
    if (rz == 0) return 0;
    if (bend > 0) {
      add_to_direction(float(bend));
      const float length = best_length();
      if (length > 0) return length;
    }
    p_.swap(z_);
    const float length = best_length();
    if (length > 0) return length;
    return definite_ ? plainly() : -1;
  }

  // To where the quadratic that the operator stands for is lowest along p_; below 0 if it has no
  // such place, or if that lies behind.
  float best_length() {
    grid_.finest().multiply(p_, Ap_);
    const auto [curvature, slope] = dots(p_, Ap_, r_);
    return curvature > 0 && slope > 0 ? float(slope / curvature) : -1;
  }

  // Without coarse grids, whose rounding can spoil an operator that is all but singular: film that
  // hangs by little. A step along this always goes down.
  float plainly() {
    grid_.finest().precondition(r_, 1, p_);
    restart_ = true;
    const float length = best_length();
    return length > 0 ? length : 1.0F / float(kWidestStep);
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
  const FilmGrid film_;
  const kernels::Table& kernels_ = kernels::best();
  Multigrid grid_;
  std::vector<std::array<double, 2>> row_sums_;
  std::vector<std::uint8_t> is_free_;
  std::vector<std::int64_t> differs_;
  Kept kept_;
  LawTangents by_law_;
  std::vector<int> look_in_;  // by row of cells: after so many updates
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
