#include "coat/printed_outline.h"

namespace hydrodip {

void PrintedOutline::keep(const DippedFilm& film) {
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t)
    kept_.push_back(film.lies_on_object(t));
}

DippedFilm PrintedOutline::applied(const DippedFilm& film, const Surface& surface,
                                   bool and_others) const {
  DippedFilm result = film;
  for (std::size_t t = 0; t < kept_.size(); ++t) {
    if (!kept_[t] || film.torn[t]) continue;
    for (const std::int32_t v : film.mesh().triangles[t]) {
      if (film.state[std::size_t(v)] != VertexState::kUnattached) continue;
      const auto below = surface.closest_point(film.position[std::size_t(v)], film.mesh().cell_mm);
      if (!below) continue;
      result.state[std::size_t(v)] = VertexState::kAttached;
      if (!result.normal.empty()) result.normal[std::size_t(v)] = surface.normal(*below);
    }
  }
  for (std::size_t t = 0; t < kept_.size(); ++t)
    if (!kept_[t] && !(and_others && film.lies_on_object(t))) result.torn[t] = 1;
  return result;
}

}  // namespace hydrodip
