// Point location in the deformed film by walking from triangle to triangle.
#pragma once

#include "film/film.h"

namespace hydrodip {

struct FilmLocation {
  std::int32_t triangle = -1;
  Vec3 weight = Vec3::Zero();  // barycentric; may be slightly negative at the edge of the film
  bool inside = false;
};

// Finds the triangle of the mesh, with its vertices at u, that holds the target, starting near
// vertex `start` (of which the target is usually a small step away). Triangles with usable[t] == 0
// and those that are turned over are not entered. If the walk leaves the usable film, the last
// triangle it was in is returned with inside = false and weights that extrapolate. `hint`: a
// triangle to look into first, or -1.
FilmLocation locate(const FilmMesh& mesh, const std::vector<Vec2>& u,
                    const std::vector<std::uint8_t>& usable, std::int32_t start, const Vec2& target,
                    std::int32_t hint = -1);

// The same in the flat film.
FilmLocation locate_flat(const FilmMesh& mesh, const Vec2& target);

}  // namespace hydrodip
