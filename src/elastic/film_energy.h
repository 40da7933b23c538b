// The film's elastic energy over all its triangles (paper Eq. 1): value, gradient, Hessian.
#pragma once

#include <cstdint>
#include <vector>

#include "elastic/corotated.h"
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

  // rest[t].area == 0 leaves triangle t out.
  void set_rest(std::vector<RestTriangle> rest) { rest_ = std::move(rest); }
  const std::vector<RestTriangle>& rest() const { return rest_; }

  double value(const VertexVector& u) const;
  // dE/du. Zero where is_free is 0.
  void gradient(const VertexVector& u, const std::vector<std::uint8_t>& is_free,
                VertexVector& out) const;
  // d2E/du2 for all vertices (no boundary conditions). definite: positive semidefinite per
  // triangle.
  void hessian(const VertexVector& u, bool definite, BlockMatrix& out) const;
  // Sum of 2 mu (or 2 mu + lambda) A grad N_a . grad N_b: the scalar operator that bounds the
  // Hessian from above and, by Korn's inequality, from below. Same sparsity as hessian().
  void laplacian(std::vector<double>& out) const;

  // The sparsity with zero blocks.
  const BlockMatrix& pattern() const { return pattern_; }

  // Whether a triangle that has film is turned over at u.
  bool any_inverted(const VertexVector& u) const;

 private:
  const FilmMesh& mesh_;
  std::vector<Lame> material_;
  std::vector<RestTriangle> rest_;
  BlockMatrix pattern_;
  // Where the block of incident triangle n (mesh.incident order) and corner b goes: slot_[3n + b].
  std::vector<std::int32_t> slot_;
  // Corner of mesh.triangles[mesh.incident[n]] that is the vertex itself.
  std::vector<std::uint8_t> own_corner_;
};

}  // namespace hydrodip
