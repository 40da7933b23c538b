// What multigrid keeps of every triangle's part of the Hessian where a material law rules.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "elastic/film_energy.h"

namespace hydrodip {

class LawTangents {
 public:
  // Computes every part at u. Those that differ from what is kept by more than the tolerance,
  // relatively, take its place; returns their triangles, ascending.
  std::vector<std::int32_t> update(const FilmEnergy& energy, const FilmMesh& mesh,
                                   const GridField& u, bool definite, double tolerance);

  // Between two of the triangle's corners: xx, xy, yx, yy.
  using Block = std::array<float, 4>;
  const Block& block(std::size_t t, std::size_t a, std::size_t b) const {
    return kept_[t][3 * a + b];
  }

 private:
  using Part = std::array<Block, 9>;
  std::vector<Part> kept_;
};

}  // namespace hydrodip
