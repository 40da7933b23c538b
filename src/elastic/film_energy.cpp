#include "elastic/film_energy.h"

#include <algorithm>
#include <atomic>
#include <numeric>

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

FilmEnergy::FilmEnergy(const FilmMesh& mesh, const std::vector<double>& modulus, double poisson)
    : mesh_(mesh), own_corner_(mesh.incident.size()) {
  const std::size_t triangles = mesh.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t) {
    const Lame material = lame(modulus.empty() ? 1.0 : modulus[t], poisson);
    mu_.push_back(material.mu);
    lambda_.push_back(material.lambda);
    for (std::size_t k = 0; k < 3; ++k) corner_[k].push_back(mesh.triangles[t][k]);
  }
  for (auto& corner : gradient_)
    for (auto& component : corner) component.assign(triangles, 0);
  for (auto& corner : force_)
    for (auto& component : corner) component.assign(triangles, 0);
  area_.assign(triangles, 0);
  for (std::size_t v = 0; v < mesh.u.size(); ++v)
    for (auto n = std::size_t(mesh.incident_begin[v]); n < std::size_t(mesh.incident_begin[v + 1]);
         ++n) {
      const Triangle& t = mesh.triangles[std::size_t(mesh.incident[n])];
      own_corner_[n] = std::size_t(t[0]) == v ? 0 : std::size_t(t[1]) == v ? 1 : 2;
    }
}

kernels::Elements FilmEnergy::elements() const {
  return {{corner_[0].data(), corner_[1].data(), corner_[2].data()},
          {{gradient_[0][0].data(), gradient_[0][1].data()},
           {gradient_[1][0].data(), gradient_[1][1].data()}},
          area_.data(),
          mu_.data(),
          lambda_.data()};
}

void FilmEnergy::set_flat_rest(const VertexVector& place, const std::vector<std::uint8_t>& film) {
  double* const gradient[2][2] = {{gradient_[0][0].data(), gradient_[0][1].data()},
                                  {gradient_[1][0].data(), gradient_[1][1].data()}};
  parallel_for(film.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    kernels::best().rest_shapes(elements(), begin, end, place.data()->data(), film.data(), gradient,
                                area_.data());
  });
}

void FilmEnergy::overstretched(const VertexVector& u, double limit,
                               std::vector<std::int64_t>& out) const {
  out.resize(area_.size());
  parallel_for(out.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    kernels::best().overstretched(elements(), begin, end, u.data()->data(), limit, out.data());
  });
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

double FilmEnergy::value(const VertexVector& u) const {
  const std::size_t count = mesh_.triangles.size();
  std::vector<double> partial((count + kElementGrain - 1) / kElementGrain, 0.0);
  parallel_for(count, kElementGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t)
      if (area_[t] > 0)
        sum += area_[t] * energy_density(gradient_at(mesh_, rest(t), t, u), material(t));
    partial[begin / kElementGrain] = sum;
  });
  double total = 0;
  for (double p : partial) total += p;
  return total;
}

std::int64_t FilmEnergy::gradient(const VertexVector& u, const std::vector<std::uint8_t>& is_free,
                                  VertexVector& out) const {
  const std::size_t triangles = mesh_.triangles.size();
  double* const force[2][2] = {{force_[0][0].data(), force_[0][1].data()},
                               {force_[1][0].data(), force_[1][1].data()}};
  std::vector<std::int64_t> turned_over((triangles + kElementGrain - 1) / kElementGrain, 0);
  parallel_for(triangles, kElementGrain, [&](std::size_t begin, std::size_t end) {
    turned_over[begin / kElementGrain] =
        kernels::best().forces(elements(), begin, end, u.data()->data(), force);
  });
  out.resize(u.size());
  parallel_for(u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      double x = 0, y = 0;
      for (auto n = std::size_t(mesh_.incident_begin[v]);
           is_free[v] && n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
        const auto t = std::size_t(mesh_.incident[n]);
        if (own_corner_[n] == 0) {
          x -= force[0][0][t] + force[1][0][t];
          y -= force[0][1][t] + force[1][1][t];
        } else {
          x += force[own_corner_[n] - 1][0][t];
          y += force[own_corner_[n] - 1][1][t];
        }
      }
      out[v] = Vec2(x, y);
    }
  });
  return std::accumulate(turned_over.begin(), turned_over.end(), std::int64_t{0});
}

void FilmEnergy::hessian(const VertexVector& u, bool definite, BlockMatrix& out) const {
  if (pattern_.row_begin.empty()) build_pattern();
  std::vector<Polar> polars(mesh_.triangles.size());
  parallel_for(polars.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (area_[t] > 0) polars[t] = polar(gradient_at(mesh_, rest(t), t, u));
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
        if (!(area_[t] > 0)) continue;
        const RestTriangle rest = this->rest(t);
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

bool FilmEnergy::any_inverted(const VertexVector& u) const {
  std::atomic<bool> found = false;
  parallel_for(mesh_.triangles.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    if (kernels::best().turned_over(elements(), begin, end, u.data()->data()) > 0) found = true;
  });
  return found;
}

}  // namespace hydrodip
