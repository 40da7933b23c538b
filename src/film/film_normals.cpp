#include "film/film_normals.h"

#include <cstdint>

namespace hydrodip {

std::vector<Vec3> film_normals(const DippedFilm& film, const Surface& surface) {
  if (!film.normal.empty()) return film.normal;
  std::vector<std::uint8_t> attached;
  for (const VertexState state : film.state) attached.push_back(state == VertexState::kAttached);
  return normals_near(surface, film.position, attached);
}

std::optional<Vec3> direction_over_edge(const DippedFilm& film, const TriangleOnObject& on,
                                        const Surface& surface) {
  const auto is_near_object = [&](const Vec3& point, double within_mm) {
    return surface.closest_point(point, within_mm).has_value();
  };
  return direction_over_edge(on.position, on.normal, on.up, film.z_stretch, is_near_object);
}

}  // namespace hydrodip
