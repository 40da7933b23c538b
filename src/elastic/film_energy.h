// The film's elastic energy over all its triangles (paper Eq. 1): value, gradient, Hessian.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "elastic/corotated.h"
#include "elastic/film_grid.h"
#include "elastic/kernels.h"
#include "elastic/material_law.h"
#include "film/film.h"

namespace hydrodip {

// Symmetric matrix of 2 x 2 blocks, one block row per vertex, in compressed rows.
struct BlockMatrix {
  std::vector<std::int32_t> row_begin;  // vertices + 1
  std::vector<std::int32_t> column;     // ascending within a row
  std::vector<Mat2> block;
};

// Bound to a mesh and a modulus per triangle; the rest state changes from step to step.
class FilmEnergy {
 public:
  // modulus: relative Young's modulus per triangle, empty for 1 everywhere. law: instead of the
  // paper's with that Poisson's ratio; may be null. Keeps a reference to the mesh.
  FilmEnergy(const FilmMesh& mesh, const std::vector<double>& modulus, double poisson,
             std::shared_ptr<const MaterialLaw> law = {});

  const FilmGrid& grid() const { return grid_; }

  // A rest triangle of area 0 leaves triangle t out.
  void set_rest(std::size_t t, const RestTriangle& rest);
  void set_rest(const std::vector<RestTriangle>& rest) {
    for (std::size_t t = 0; t < rest.size(); ++t) set_rest(t, rest[t]);
  }
  RestTriangle rest(std::size_t t) const;

  // Whether set_flat_rest() gives triangle t a rest shape. At first all have film.
  void set_film(std::size_t t, bool has_film) { film_[grid_.element(t)] = has_film ? 1 : 0; }
  // Of all triangles at once: where the vertices lie in the plane. Returns, in no useful order, the
  // triangles with film whose area comes out below least_share of that on the flat film.
  std::vector<std::int32_t> set_flat_rest(const GridField& place, double least_share);

  Lame material(std::size_t t) const {
    const double mu = mu_[grid_.element(t)];
    return {mu, lambda_per_mu_ * mu};
  }
  // All of it as arrays.
  kernels::Elements elements() const;
  // Of one's own; null: the paper's.
  const MaterialLaw* law() const { return law_.get(); }
  double modulus(std::size_t t) const { return modulus_per_mu_ * mu_[grid_.element(t)]; }

  // The triangles in which film is stretched further than the limit at u, ascending.
  std::vector<std::int32_t> overstretched(const GridField& u, double limit) const;

  double value(const GridField& u) const;
  // dE/du times the mask (1 where a vertex is free, 0 elsewhere). Returns how many triangles are
  // turned over.
  std::int64_t gradient(const GridField& u, const GridArray<double>& mask, GridField& out) const;
  // d2E/du2 for all vertices (no boundary conditions). definite: positive semidefinite per
  // triangle.
  void hessian(const VertexVector& u, bool definite, BlockMatrix& out) const;
  // Whether a triangle that has film is turned over at u.
  bool any_inverted(const GridField& u) const;
  // Those, ascending.
  std::vector<std::int32_t> inverted(const GridField& u) const;

 private:
  void build_pattern() const;
  // film_energy_by_law.cpp
  LawState law_state_at(std::size_t t, const RestTriangle& rest, const GridField& u) const;
  double value_by_law(const GridField& u) const;
  std::int64_t gradient_by_law(const GridField& u, const GridArray<double>& mask,
                               GridField& out) const;
  void hessian_by_law(const VertexVector& u, bool definite, BlockMatrix& out) const;

  const FilmMesh& mesh_;
  std::shared_ptr<const MaterialLaw> law_;
  FilmGrid grid_;
  // Over elements (kernels::Elements).
  GridArray<double> gradient_[2][2], area_, mu_, film_, flat_area_;
  double lambda_per_mu_, modulus_per_mu_;  // Poisson's ratio is the same everywhere
  // Corner of mesh.triangles[mesh.incident[n]] that is the vertex itself.
  std::vector<std::uint8_t> own_corner_;
  mutable std::vector<std::int64_t> flags_;  // scratch of overstretched()

  // Of hessian(), made when it is first called.
  mutable BlockMatrix pattern_;
  // Where the block of incident triangle n (mesh.incident order) and corner b goes: slot_[3n + b].
  mutable std::vector<std::int32_t> slot_;
};

}  // namespace hydrodip
