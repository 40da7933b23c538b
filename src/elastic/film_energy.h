// The film's elastic energy over all its triangles (paper Eq. 1): value, gradient, Hessian.
#pragma once

#include <cstdint>
#include <vector>

#include "elastic/corotated.h"
#include "elastic/kernels.h"
#include "film/film.h"

namespace hydrodip {

// Symmetric matrix of 2 x 2 blocks, one block row per vertex, in compressed rows.
struct BlockMatrix {
  std::vector<std::int32_t> row_begin;  // vertices + 1
  std::vector<std::int32_t> column;     // ascending within a row
  std::vector<Mat2> block;
};

// Vectors over vertices: 2 values per vertex.
using VertexVector = std::vector<Vec2>;

// Bound to a mesh and a modulus per triangle; the rest state changes from step to step.
class FilmEnergy {
 public:
  // modulus: relative Young's modulus per triangle, empty for 1 everywhere. Keeps a reference to
  // the mesh.
  FilmEnergy(const FilmMesh& mesh, const std::vector<double>& modulus, double poisson);

  // A rest triangle of area 0 leaves triangle t out.
  void set_rest(std::size_t t, const RestTriangle& rest) {
    for (std::size_t corner = 0; corner < 2; ++corner)
      for (std::size_t c = 0; c < 2; ++c)
        gradient_[corner][c][t] = rest.gradient(Eigen::Index(corner) + 1, Eigen::Index(c));
    area_[t] = rest.area;
  }
  void set_rest(const std::vector<RestTriangle>& rest) {
    for (std::size_t t = 0; t < rest.size(); ++t) set_rest(t, rest[t]);
  }
  // Of all triangles at once: where the vertices lie in the plane, and 1 for triangles with film.
  void set_flat_rest(const VertexVector& place, const std::vector<std::uint8_t>& film);
  RestTriangle rest(std::size_t t) const {
    RestTriangle rest;
    for (std::size_t c = 0; c < 2; ++c) {
      const double g1 = gradient_[0][c][t], g2 = gradient_[1][c][t];
      rest.gradient.col(Eigen::Index(c)) << -(g1 + g2), g1, g2;
    }
    rest.area = area_[t];
    return rest;
  }
  Lame material(std::size_t t) const { return {mu_[t], lambda_[t]}; }
  // The same as arrays.
  kernels::Elements elements() const;

  // 1 where the film is stretched further than the limit at u.
  void overstretched(const VertexVector& u, double limit, std::vector<std::int64_t>& out) const;

  double value(const VertexVector& u) const;
  // dE/du; zero where is_free is 0. Returns how many triangles are turned over.
  std::int64_t gradient(const VertexVector& u, const std::vector<std::uint8_t>& is_free,
                        VertexVector& out) const;
  // d2E/du2 for all vertices (no boundary conditions). definite: positive semidefinite per
  // triangle.
  void hessian(const VertexVector& u, bool definite, BlockMatrix& out) const;
  // Whether a triangle that has film is turned over at u.
  bool any_inverted(const VertexVector& u) const;

 private:
  void build_pattern() const;

  const FilmMesh& mesh_;
  std::vector<std::int32_t> corner_[3];
  std::vector<double> gradient_[2][2], area_, mu_, lambda_;
  // Corner of mesh.triangles[mesh.incident[n]] that is the vertex itself.
  std::vector<std::uint8_t> own_corner_;
  mutable std::vector<double> force_[2][2];  // scratch of gradient()

  // Of hessian(), made when it is first called.
  mutable BlockMatrix pattern_;
  // Where the block of incident triangle n (mesh.incident order) and corner b goes: slot_[3n + b].
  mutable std::vector<std::int32_t> slot_;
};

}  // namespace hydrodip
