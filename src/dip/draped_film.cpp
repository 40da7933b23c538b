#include "dip/draped_film.h"

#include "base/parallel.h"
#include "film/locate.h"

namespace hydrodip {

namespace {

// A walk of bounded length at a time, until the target's triangle is found.
FilmLocation find(const FilmMesh& film, const VertexVector& u,
                  const std::vector<std::uint8_t>& everywhere, std::int32_t vertex) {
  const Vec2& target = film.u[std::size_t(vertex)];
  FilmLocation at = locate(film, u, everywhere, vertex, target);
  for (int walks = film.nx + film.ny; !at.inside && at.triangle >= 0 && walks > 0; --walks) {
    int nearest = 0;
    at.weight.maxCoeff(&nearest);
    const std::int32_t start = film.triangles[std::size_t(at.triangle)][std::size_t(nearest)];
    const FilmLocation next = locate(film, u, everywhere, start, target);
    if (next.triangle == at.triangle) break;
    at = next;
  }
  return at;
}

}  // namespace

std::vector<std::uint8_t> rise_to(double level, const DipSetting& setting, DipState& state) {
  std::vector<std::uint8_t> meets(state.position.size(), 0);
  parallel_for(meets.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3& position = state.position[v];
      if (state.state[v] == VertexState::kClamped) position.z() = level;
      if (state.state[v] != VertexState::kUnattached) continue;
      const Vec3 risen(position.x(), position.y(), level);
      const auto contact = first_contact(setting.surface, position, risen);
      meets[v] = contact.has_value();
      // Straight up: the ray's rounding must not push the vertex sideways.
      position = Vec3(position.x(), position.y(), contact ? contact->position.z() : level);
    }
  });
  return meets;
}

std::vector<RestTriangle> rest_in_space(const FilmMesh& film, const std::vector<Vec3>& position,
                                        const std::vector<std::uint8_t>& is_free,
                                        double z_stretch) {
  const auto scaled = [&](std::int32_t v) {
    const Vec3& p = position[std::size_t(v)];
    return Vec3(p.x(), p.y(), p.z() * z_stretch);
  };
  std::vector<RestTriangle> rest(film.triangles.size());
  parallel_for(rest.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = film.triangles[t];
      if (is_free[std::size_t(v[0])] || is_free[std::size_t(v[1])] || is_free[std::size_t(v[2])])
        rest[t] = rest_triangle(scaled(v[0]), scaled(v[1]), scaled(v[2]));
    }
  });
  return rest;
}

std::vector<Vec3> mapped_back(const FilmMesh& film, const std::vector<Vec3>& position,
                              const std::vector<std::uint8_t>& is_free, const VertexVector& u) {
  const std::vector<std::uint8_t> everywhere(film.triangles.size(), 1);
  std::vector<Vec3> mapped = position;
  parallel_for(mapped.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!is_free[v]) continue;
      const FilmLocation at = find(film, u, everywhere, static_cast<std::int32_t>(v));
      if (at.triangle < 0) continue;
      Vec3 place = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        place += at.weight[Eigen::Index(k)] *
                 position[std::size_t(film.triangles[std::size_t(at.triangle)][k])];
      if (place.allFinite()) mapped[v] = place;
    }
  });
  return mapped;
}

}  // namespace hydrodip
