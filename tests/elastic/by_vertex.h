// Fields over vertices, where the solver computes on the film's grid.
#pragma once

#include "elastic/film_energy.h"
#include "elastic/linear_solver.h"

namespace hydrodip::fixtures {

inline VertexVector gradient_by_vertex(const FilmEnergy& energy, const VertexVector& u,
                                       const std::vector<std::uint8_t>& is_free) {
  const FilmGrid& grid = energy.grid();
  GridArray<double> mask(grid.layout().entries());
  grid.to_mask(is_free, mask);
  GridField gradient(grid.layout());
  energy.gradient(grid.field(u), mask, gradient);
  VertexVector result;
  grid.to_vertices(gradient, result);
  return result;
}

inline VertexVector by_vertex(const FilmGrid& grid, const SearchDirection& direction) {
  VertexVector step(grid.vertices());
  for (std::size_t v = 0; v < step.size(); ++v)
    step[v] =
        direction.length * Vec2(direction.way.x[grid.place(v)], direction.way.y[grid.place(v)]);
  return step;
}

}  // namespace hydrodip::fixtures
