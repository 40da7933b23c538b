#include "elastic/film_energy.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"

namespace hydrodip {

namespace {

Mat2 gradient_at(const FilmMesh& mesh, const RestTriangle& rest, std::size_t t,
                 const VertexVector& u) {
  const Triangle& v = mesh.triangles[t];
  return deformation_gradient(rest, u[std::size_t(v[0])], u[std::size_t(v[1])],
                              u[std::size_t(v[2])]);
}

}  // namespace

FilmEnergy::FilmEnergy(const FilmMesh& mesh, const std::vector<double>& modulus, double poisson,
                       std::shared_ptr<const MaterialLaw> law)
    : mesh_(mesh),
      law_(std::move(law)),
      grid_(mesh),
      lambda_per_mu_(lame(1, poisson).lambda / lame(1, poisson).mu),
      modulus_per_mu_(1 / lame(1, poisson).mu),
      own_corner_(mesh.incident.size()) {
  for (auto& corner : gradient_)
    for (auto& component : corner) component = GridArray<double>(grid_.elements());
  for (auto* values : {&area_, &mu_, &film_, &flat_area_})
    *values = GridArray<double>(grid_.elements());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t e = grid_.element(t);
    mu_[e] = lame(modulus.empty() ? 1.0 : modulus[t], poisson).mu;
    film_[e] = 1;
    const Triangle& v = mesh.triangles[t];
    const Vec2& a = mesh.u[std::size_t(v[0])];
    flat_area_[e] = 0.5 * cross2(mesh.u[std::size_t(v[1])] - a, mesh.u[std::size_t(v[2])] - a);
  }
  for (std::size_t v = 0; v < mesh.u.size(); ++v)
    for (auto n = std::size_t(mesh.incident_begin[v]); n < std::size_t(mesh.incident_begin[v + 1]);
         ++n) {
      const Triangle& t = mesh.triangles[std::size_t(mesh.incident[n])];
      own_corner_[n] = std::size_t(t[0]) == v ? 0 : std::size_t(t[1]) == v ? 1 : 2;
    }
}

kernels::Elements FilmEnergy::elements() const {
  const GridLayout& layout = grid_.layout();
  return {layout.stride,
          layout.nx,
          layout.ny,
          {grid_.rising(0).data(), grid_.rising(1).data()},
          std::ptrdiff_t(layout.entries()),
          {{gradient_[0][0].data(), gradient_[0][1].data()},
           {gradient_[1][0].data(), gradient_[1][1].data()}},
          area_.data(),
          mu_.data(),
          lambda_per_mu_};
}

void FilmEnergy::set_rest(std::size_t t, const RestTriangle& rest) {
  const std::size_t e = grid_.element(t);
  for (int corner = 1; corner < 3; ++corner)
    for (int c = 0; c < 2; ++c)
      gradient_[corner - 1][c][e] = rest.gradient((corner + grid_.first_corner(t)) % 3, c);
  area_[e] = rest.area;
}

RestTriangle FilmEnergy::rest(std::size_t t) const {
  const std::size_t e = grid_.element(t);
  const int first = grid_.first_corner(t);
  RestTriangle rest;
  for (int c = 0; c < 2; ++c) {
    const double g1 = gradient_[0][c][e], g2 = gradient_[1][c][e];
    rest.gradient(first, c) = -(g1 + g2);
    rest.gradient((1 + first) % 3, c) = g1;
    rest.gradient((2 + first) % 3, c) = g2;
  }
  rest.area = area_[e];
  return rest;
}

std::vector<std::int32_t> FilmEnergy::set_flat_rest(const GridField& place, double least_share) {
  double* const gradient[2][2] = {{gradient_[0][0].data(), gradient_[0][1].data()},
                                  {gradient_[1][0].data(), gradient_[1][1].data()}};
  const kernels::Elements elements = this->elements();
  std::atomic<std::int64_t> small = 0;
  grid_.layout().for_rows(elements.ny - 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    small += kernels::best().rest_shapes(elements, begin, end, place, film_.data(),
                                         flat_area_.data(), least_share, gradient, area_.data());
  });
  std::vector<std::int32_t> list;
  for (std::size_t e = 0; e < grid_.elements() && small > 0; ++e)
    if (film_[e] > 0 && area_[e] < least_share * flat_area_[e]) list.push_back(grid_.triangle(e));
  return list;
}

std::vector<std::int32_t> FilmEnergy::overstretched(const GridField& u, double limit) const {
  const kernels::Elements elements = this->elements();
  flags_.resize(grid_.elements());
  std::atomic<bool> any = false;
  grid_.layout().for_rows(elements.ny - 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    kernels::best().overstretched(elements, begin, end, u, limit, flags_.data());
    const auto first = grid_.layout().place(0, int(begin)),
               last = grid_.layout().place(0, int(end));
    for (const std::size_t half : {std::size_t(0), grid_.layout().entries()})
      if (std::any_of(flags_.begin() + std::ptrdiff_t(half + first),
                      flags_.begin() + std::ptrdiff_t(half + last),
                      [](std::int64_t flag) { return flag != 0; }))
        any = true;
  });
  std::vector<std::int32_t> list;
  for (std::size_t t = 0; t < mesh_.triangles.size() && any; ++t)
    if (flags_[grid_.element(t)]) list.push_back(static_cast<std::int32_t>(t));
  return list;
}

void FilmEnergy::build_pattern() const {
  pattern_.row_begin.push_back(0);
  slot_.resize(3 * mesh_.incident.size());
  for (std::size_t v = 0; v < mesh_.u.size(); ++v) {
    std::vector<std::int32_t> row;
    const auto begin = mesh_.incident_begin[v], end = mesh_.incident_begin[v + 1];
    for (auto n = begin; n < end; ++n)
      for (std::int32_t other : mesh_.triangles[std::size_t(mesh_.incident[std::size_t(n)])])
        row.push_back(other);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    const auto base = static_cast<std::int32_t>(pattern_.column.size());
    for (auto n = begin; n < end; ++n) {
      const Triangle& t = mesh_.triangles[std::size_t(mesh_.incident[std::size_t(n)])];
      for (std::size_t b = 0; b < 3; ++b) {
        const auto at = std::lower_bound(row.begin(), row.end(), t[b]) - row.begin();
        slot_[3 * std::size_t(n) + b] = base + static_cast<std::int32_t>(at);
      }
    }
    pattern_.column.insert(pattern_.column.end(), row.begin(), row.end());
    pattern_.row_begin.push_back(static_cast<std::int32_t>(pattern_.column.size()));
  }
  pattern_.block.assign(pattern_.column.size(), Mat2::Zero());
}

double FilmEnergy::value(const GridField& u) const {
  if (law_) return value_by_law(u);
  const kernels::Elements elements = this->elements();
  // By the first row of a part, so that they are added up in the same order on any threads.
  std::vector<double> part(std::size_t(elements.ny), 0.0);
  grid_.layout().for_rows(elements.ny - 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<double> columns(std::size_t(elements.stride), 0.0);
    kernels::best().energy(elements, begin, end, u, columns.data());
    for (const double column : columns) part[std::size_t(begin)] += column;
  });
  return std::accumulate(part.begin(), part.end(), 0.0);
}

std::int64_t FilmEnergy::gradient(const GridField& u, const GridArray<double>& mask,
                                  GridField& out) const {
  if (law_) return gradient_by_law(u, mask, out);
  const kernels::Elements elements = this->elements();
  std::atomic<std::int64_t> turned_over = 0;
  grid_.layout().for_rows(elements.ny, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    GridArray<double> scratch(std::size_t(kernels::kScratchRows * elements.stride));
    turned_over +=
        kernels::best().gradient(elements, begin, end, u, mask.data(), out, scratch.data());
  });
  return turned_over;
}

void FilmEnergy::hessian(const VertexVector& u, bool definite, BlockMatrix& out) const {
  if (pattern_.row_begin.empty()) build_pattern();
  if (law_) {
    if (out.column.size() != pattern_.column.size()) out = pattern_;
    hessian_by_law(u, definite, out);
    return;
  }
  std::vector<Polar> polars(mesh_.triangles.size());
  parallel_for(polars.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (rest(t).area > 0) polars[t] = polar(gradient_at(mesh_, rest(t), t, u));
  });
  if (out.column.size() != pattern_.column.size()) out = pattern_;
  parallel_for(u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (auto s = std::size_t(pattern_.row_begin[v]); s < std::size_t(pattern_.row_begin[v + 1]);
           ++s)
        out.block[s].setZero();
      for (auto n = std::size_t(mesh_.incident_begin[v]);
           n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
        const auto t = std::size_t(mesh_.incident[n]);
        const RestTriangle rest = this->rest(t);
        if (!(rest.area > 0)) continue;
        const Polar& p = polars[t];
        const Lame m = material(t);
        const double turning = rest.area * turning_stiffness(p, m, definite);
        const double dilating = rest.area * m.lambda;
        const auto rotated = [&](Eigen::Index corner) {  // R grad N
          const double x = rest.gradient(corner, 0), y = rest.gradient(corner, 1);
          return Vec2(p.cosine * x - p.sine * y, p.sine * x + p.cosine * y);
        };
        const auto turned = [&](Eigen::Index corner) {  // Q grad N = R J grad N
          const double x = -rest.gradient(corner, 1), y = rest.gradient(corner, 0);
          return Vec2(p.cosine * x - p.sine * y, p.sine * x + p.cosine * y);
        };
        const Eigen::Index a = own_corner_[n];
        const Vec2 ra = dilating * rotated(a), qa = turning * turned(a);
        for (Eigen::Index b = 0; b < 3; ++b) {
          Mat2& block = out.block[std::size_t(slot_[3 * n + std::size_t(b)])];
          const double stretch =
              2 * m.mu * rest.area * rest.gradient.row(a).dot(rest.gradient.row(b));
          block(0, 0) += stretch;
          block(1, 1) += stretch;
          block += ra * rotated(b).transpose() + qa * turned(b).transpose();
        }
      }
    }
  });
}

bool FilmEnergy::any_inverted(const GridField& u) const {
  const kernels::Elements elements = this->elements();
  std::atomic<bool> found = false;
  grid_.layout().for_rows(elements.ny - 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    if (kernels::best().turned_over(elements, begin, end, u) > 0) found = true;
  });
  return found;
}

std::vector<std::int32_t> FilmEnergy::inverted(const GridField& u) const {
  std::vector<std::int32_t> list;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!(area_[grid_.element(t)] > 0)) continue;
    const std::array<Vec2, 3> at = grid_.corners(mesh_.triangles[t], u);
    if (!(cross2(at[1] - at[0], at[2] - at[0]) > 0)) list.push_back(std::int32_t(t));
  }
  return list;
}

}  // namespace hydrodip
