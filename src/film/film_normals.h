// The object under film that lies on it: its normals, and its edges.
#pragma once

#include <optional>
#include <vector>

#include "film/film.h"
#include "film/over_edge.h"
#include "object/surface.h"

namespace hydrodip {

// DippedFilm::normal, looked for on the object if nobody has.
std::vector<Vec3> film_normals(const DippedFilm& film, const Surface& surface);

// direction_over_edge() of a triangle of film on that object.
std::optional<Vec3> direction_over_edge(const DippedFilm& film, const TriangleOnObject& on,
                                        const Surface& surface);

}  // namespace hydrodip
