// The harness that every energy has to pass: gradient and Hessian against finite differences, on
// film that is strained at random.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "elastic/by_vertex.h"
#include "elastic/film_energy.h"

namespace hydrodip::fixtures {

// A small film with every triangle at its own rest shape, stiffness and strain.
struct RandomFilm {
  FilmMesh mesh =
      make_film_mesh({.width_mm = 60, .height_mm = 50, .margin_mm = 5, .elements = 120});
  std::vector<double> modulus;
  std::vector<RestTriangle> rest;
  VertexVector u;
  std::vector<std::uint8_t> is_free;

  explicit RandomFilm(unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    VertexVector x = mesh.u;
    u = mesh.u;
    for (std::size_t v = 0; v < x.size(); ++v) {
      x[v] += 0.12 * mesh.cell_mm * Vec2(unit(generator), unit(generator));
      u[v] = 0.8 * u[v] + 0.12 * mesh.cell_mm * Vec2(unit(generator), unit(generator));
      is_free.push_back(!mesh.on_rim[v]);
    }
    for (const Triangle& t : mesh.triangles) {
      modulus.push_back(std::exp(2 * unit(generator)));
      rest.push_back(
          rest_triangle(x[std::size_t(t[0])], x[std::size_t(t[1])], x[std::size_t(t[2])]));
    }
  }
  FilmEnergy energy(double poisson, std::shared_ptr<const MaterialLaw> law = {}) const {
    FilmEnergy e(mesh, modulus, poisson, std::move(law));
    e.set_rest(rest);
    return e;
  }
};

// Of `at(d)` by d, with an error that falls with the fourth power of the width.
template <typename Value, typename At>
Value difference(const At& at, double h) {
  const Value near_above = at(h), near_below = at(-h), above = at(2 * h), below = at(-2 * h);
  return (8 * (near_above - near_below) - (above - below)) / (12 * h);
}

inline void expect_gradient(const FilmEnergy& energy, const VertexVector& place,
                            const std::vector<std::uint8_t>& is_free, double share) {
  const VertexVector gradient = gradient_by_vertex(energy, place, is_free);
  double scale = 0, worst = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (!is_free[v]) {
      EXPECT_EQ(gradient[v].norm(), 0);
      continue;
    }
    for (int k = 0; k < 2; ++k) {
      const auto at = [&](double d) {
        VertexVector u = place;
        u[v][k] += d;
        return energy.value(energy.grid().field(u));
      };
      const double found = difference<double>(at, 1e-4);
      scale = std::max(scale, std::abs(found));
      worst = std::max(worst, std::abs(found - gradient[v][k]));
    }
  }
  EXPECT_LT(worst, share * scale);
}

inline void expect_hessian(const FilmEnergy& energy, const VertexVector& place, double share) {
  const std::vector<std::uint8_t> all(place.size(), 1);
  BlockMatrix H;
  energy.hessian(place, false, H);
  double scale = 0, worst = 0;
  for (std::size_t w = 0; w < place.size(); ++w)
    for (int k = 0; k < 2; ++k) {
      const auto at = [&](double d) {
        VertexVector u = place;
        u[w][k] += d;
        const VertexVector gradient = gradient_by_vertex(energy, u, all);
        Eigen::VectorXd flat(2 * Eigen::Index(u.size()));
        for (std::size_t v = 0; v < u.size(); ++v)
          flat.segment<2>(2 * Eigen::Index(v)) = gradient[v];
        return flat;
      };
      const Eigen::VectorXd found = difference<Eigen::VectorXd>(at, 1e-3);
      for (std::size_t v = 0; v < place.size(); ++v) {
        Vec2 analytic = Vec2::Zero();
        for (auto s = H.row_begin[v]; s < H.row_begin[v + 1]; ++s)
          if (std::size_t(H.column[std::size_t(s)]) == w) analytic = H.block[std::size_t(s)].col(k);
        const Vec2 there = found.segment<2>(2 * Eigen::Index(v));
        scale = std::max(scale, there.norm());
        worst = std::max(worst, (there - analytic).norm());
      }
    }
  EXPECT_LT(worst, share * scale);
}

}  // namespace hydrodip::fixtures
