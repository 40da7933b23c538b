// FilmEnergy where a material law of one's own rules: plain loops over triangles.
#include <atomic>
#include <numeric>

#include "base/parallel.h"
#include "elastic/film_energy.h"
#include "elastic/material_law.h"

namespace hydrodip {

LawState FilmEnergy::law_state_at(std::size_t t, const RestTriangle& rest,
                                  const GridField& u) const {
  const std::array<Vec2, 3> at = grid_.corners(mesh_.triangles[t], u);
  return law_state(*law_, deformation_gradient(rest, at[0], at[1], at[2]));
}

double FilmEnergy::value_by_law(const GridField& u) const {
  const std::size_t triangles = mesh_.triangles.size();
  // Added up in the same order on any threads.
  std::vector<double> part(triangles / kElementGrain + 1, 0.0);
  parallel_for(triangles, kElementGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const RestTriangle rest = this->rest(t);
      if (rest.area > 0) sum += rest.area * modulus(t) * law_state_at(t, rest, u).energy;
    }
    part[begin / kElementGrain] = sum;
  });
  return std::accumulate(part.begin(), part.end(), 0.0);
}

std::int64_t FilmEnergy::gradient_by_law(const GridField& u, const GridArray<double>& mask,
                                         GridField& out) const {
  const std::size_t triangles = mesh_.triangles.size();
  std::vector<std::array<Vec2, 3>> force(triangles, {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()});
  std::atomic<std::int64_t> turned_over = 0;
  parallel_for(triangles, kElementGrain, [&](std::size_t begin, std::size_t end) {
    std::int64_t found = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const RestTriangle rest = this->rest(t);
      if (!(rest.area > 0)) continue;
      const LawState state = law_state_at(t, rest, u);
      const Mat2 P = rest.area * modulus(t) * law_stress(state);
      for (Eigen::Index k = 0; k < 3; ++k)
        force[t][std::size_t(k)] = P * rest.gradient.row(k).transpose();
      found += state.p > state.q ? 0 : 1;  // det F = (p^2 - q^2) / 4
    }
    turned_over += found;
  });
  out.x.set_zero();
  out.y.set_zero();
  parallel_for(mesh_.u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec2 sum = Vec2::Zero();
      for (auto n = std::size_t(mesh_.incident_begin[v]);
           n < std::size_t(mesh_.incident_begin[v + 1]); ++n)
        sum += force[std::size_t(mesh_.incident[n])][own_corner_[n]];
      const std::size_t place = grid_.place(v);
      out.set(place, mask[place] * sum);
    }
  });
  return turned_over;
}

void FilmEnergy::hessian_by_law(const VertexVector& u, bool definite, BlockMatrix& out) const {
  const GridField at = grid_.field(u);
  for (Mat2& block : out.block) block.setZero();
  for (std::size_t v = 0; v < u.size(); ++v)
    for (auto n = std::size_t(mesh_.incident_begin[v]);
         n < std::size_t(mesh_.incident_begin[v + 1]); ++n) {
      const auto t = std::size_t(mesh_.incident[n]);
      const RestTriangle rest = this->rest(t);
      if (!(rest.area > 0)) continue;
      const LawStiffness stiffness(law_state_at(t, rest, at), definite);
      const Vec2 own = rest.gradient.row(own_corner_[n]);
      for (Eigen::Index b = 0; b < 3; ++b)
        out.block[std::size_t(slot_[3 * n + std::size_t(b)])] +=
            rest.area * modulus(t) * stiffness.block(own, rest.gradient.row(b));
    }
}

}  // namespace hydrodip
