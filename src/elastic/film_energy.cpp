#include "elastic/film_energy.h"

#include <algorithm>

#include "base/parallel.h"

namespace hydrodip {

namespace {

constexpr std::size_t kGrain = 4096;

Mat2 gradient_at(const FilmMesh& mesh, const RestTriangle& rest, std::size_t t,
                 const VertexVector& u) {
  const Triangle& v = mesh.triangles[t];
  return deformation_gradient(rest, u[std::size_t(v[0])], u[std::size_t(v[1])],
                              u[std::size_t(v[2])]);
}

}  // namespace

FilmEnergy::FilmEnergy(const FilmMesh& mesh, const std::vector<double>& modulus, double poisson)
    : mesh_(mesh), rest_(mesh.triangles.size()) {
  material_.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    material_.push_back(lame(modulus.empty() ? 1.0 : modulus[t], poisson));

  const std::size_t vertices = mesh.u.size();
  pattern_.row_begin.push_back(0);
  slot_.resize(3 * mesh.incident.size());
  own_corner_.resize(mesh.incident.size());
  for (std::size_t v = 0; v < vertices; ++v) {
    std::vector<std::int32_t> row;
    const auto begin = mesh.incident_begin[v], end = mesh.incident_begin[v + 1];
    for (auto n = begin; n < end; ++n)
      for (std::int32_t other : mesh.triangles[std::size_t(mesh.incident[std::size_t(n)])])
        row.push_back(other);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    const auto base = static_cast<std::int32_t>(pattern_.column.size());
    for (auto n = begin; n < end; ++n) {
      const Triangle& t = mesh.triangles[std::size_t(mesh.incident[std::size_t(n)])];
      for (std::size_t b = 0; b < 3; ++b) {
        const auto at = std::lower_bound(row.begin(), row.end(), t[b]) - row.begin();
        slot_[3 * std::size_t(n) + b] = base + static_cast<std::int32_t>(at);
        if (std::size_t(t[b]) == v) own_corner_[std::size_t(n)] = static_cast<std::uint8_t>(b);
      }
    }
    pattern_.column.insert(pattern_.column.end(), row.begin(), row.end());
    pattern_.row_begin.push_back(static_cast<std::int32_t>(pattern_.column.size()));
  }
  pattern_.block.assign(pattern_.column.size(), Mat2::Zero());
}

double FilmEnergy::value(const VertexVector& u) const {
  const std::size_t count = mesh_.triangles.size();
  std::vector<double> partial((count + kGrain - 1) / kGrain, 0.0);
  parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t)
      if (rest_[t].area > 0)
        sum += rest_[t].area * energy_density(gradient_at(mesh_, rest_[t], t, u), material_[t]);
    partial[begin / kGrain] = sum;
  });
  double total = 0;
  for (double p : partial) total += p;
  return total;
}

void FilmEnergy::gradient(const VertexVector& u, const std::vector<std::uint8_t>& is_free,
                          VertexVector& out) const {
  std::vector<Mat2> weighted(mesh_.triangles.size());
  parallel_for(weighted.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (rest_[t].area > 0)
        weighted[t] = rest_[t].area * stress(gradient_at(mesh_, rest_[t], t, u), material_[t]);
  });
  out.resize(u.size());
  parallel_for(u.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      out[v].setZero();
      if (!is_free[v]) continue;
      for (auto n = std::size_t(mesh_.incident_begin[v]);
           n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
        const auto t = std::size_t(mesh_.incident[n]);
        if (rest_[t].area > 0)
          out[v] += weighted[t] * rest_[t].gradient.row(own_corner_[n]).transpose();
      }
    }
  });
}

void FilmEnergy::hessian(const VertexVector& u, bool definite, BlockMatrix& out) const {
  std::vector<Polar> polars(mesh_.triangles.size());
  parallel_for(polars.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (rest_[t].area > 0) polars[t] = polar(gradient_at(mesh_, rest_[t], t, u));
  });
  if (out.column.size() != pattern_.column.size()) out = pattern_;
  parallel_for(u.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (auto s = std::size_t(pattern_.row_begin[v]); s < std::size_t(pattern_.row_begin[v + 1]);
           ++s)
        out.block[s].setZero();
      for (auto n = std::size_t(mesh_.incident_begin[v]);
           n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
        const auto t = std::size_t(mesh_.incident[n]);
        const RestTriangle& rest = rest_[t];
        if (!(rest.area > 0)) continue;
        const Polar& p = polars[t];
        const Lame& m = material_[t];
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

void FilmEnergy::laplacian(std::vector<double>& out) const {
  out.assign(pattern_.column.size(), 0.0);
  parallel_for(mesh_.u.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      for (auto n = std::size_t(mesh_.incident_begin[v]);
           n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
        const auto t = std::size_t(mesh_.incident[n]);
        const RestTriangle& rest = rest_[t];
        if (!(rest.area > 0)) continue;
        const double weight =
            rest.area * (2 * material_[t].mu + std::max(0.0, material_[t].lambda));
        const Eigen::Index a = own_corner_[n];
        for (Eigen::Index b = 0; b < 3; ++b)
          out[std::size_t(slot_[3 * n + std::size_t(b)])] +=
              weight * rest.gradient.row(a).dot(rest.gradient.row(b));
      }
  });
}

bool FilmEnergy::any_inverted(const VertexVector& u) const {
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!(rest_[t].area > 0)) continue;
    const Triangle& v = mesh_.triangles[t];
    const Vec2& a = u[std::size_t(v[0])];
    if (!(cross2(u[std::size_t(v[1])] - a, u[std::size_t(v[2])] - a) > 0)) return true;
  }
  return false;
}

}  // namespace hydrodip
