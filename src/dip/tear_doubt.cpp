#include "dip/tear_doubt.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "film/locate.h"

namespace hydrodip {

namespace {

// The two dips are made on film of so many times fewer triangles, but at least so many, in steps
// that are so many times longer, up to a length.
constexpr int kFewer = 4;
constexpr int kFewestElements = 4000;
constexpr double kLonger = 2;
constexpr double kLongestStep_mm = 1;
// Film that one of the two has lost lies nowhere.
constexpr double kNowhere_mm = 10;

FilmOptions coarser(FilmOptions film) {
  film.elements = std::min(film.elements, std::max(film.elements / kFewer, kFewestElements));
  return film;
}

// In the middle of three parts of each triangle.
std::vector<double> modulus_on(const FilmMesh& coarse, const FilmMesh& fine,
                               const std::vector<double>& modulus) {
  std::vector<double> result(coarse.triangles.size(), 1);
  parallel_for(result.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = coarse.triangles[t];
      double sum = 0, count = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 place =
            (4 * coarse.u[std::size_t(v[k])] + coarse.u[std::size_t(v[(k + 1) % 3])] +
             coarse.u[std::size_t(v[(k + 2) % 3])]) /
            6;
        const FilmLocation at = locate_flat(fine, place);
        if (!at.inside) continue;
        sum += modulus[std::size_t(at.triangle)];
        ++count;
      }
      if (count > 0) result[t] = sum / count;
    }
  });
  return result;
}

// Per vertex: whether any film there is left.
std::vector<std::uint8_t> left_over(const DippedFilm& film) {
  std::vector<std::uint8_t> left(film.position.size(), 0);
  for (std::size_t t = 0; t < film.torn.size(); ++t)
    if (!std::isfinite(film.torn_at_mm[t]))
      for (std::int32_t v : film.mesh().triangles[t]) left[std::size_t(v)] = 1;
  return left;
}

}  // namespace

std::vector<double> moved_by_tears(const DippedFilm& dipped, const std::vector<Vec3>& positions,
                                   const std::vector<Triangle>& triangles, const Surface& surface,
                                   const Trajectory& trajectory, const DipOptions& options,
                                   const RunContext& context) {
  const FilmMesh& film = dipped.mesh();
  const auto coarse = std::make_shared<const FilmMesh>(make_film_mesh(coarser(film.options)));
  DipOptions either = options;
  either.step_mm = std::min(kLonger * options.step_mm, std::max(options.step_mm, kLongestStep_mm));
  if (!options.modulus.empty()) either.modulus = modulus_on(*coarse, film, options.modulus);
  either.asks_what_moves = false;
  either.moved_mm.clear();
  const auto dip_that_lets_go = [&](double at) {
    either.material.tear_stretch = either.material.lost_stretch = at;
    return dip(coarse, positions, triangles, surface, trajectory, either, context.quiet()).film;
  };
  const FilmMaterial& material = options.material;
  const DippedFilm late = dip_that_lets_go(std::max(material.lost_stretch, material.tear_stretch));
  const DippedFilm early = dip_that_lets_go(std::min(material.safe_stretch, material.tear_stretch));
  const std::vector<std::uint8_t> left = left_over(early);
  std::vector<double> moved(coarse->u.size());
  for (std::size_t v = 0; v < moved.size(); ++v)
    moved[v] = left[v] ? std::min(kNowhere_mm, (late.position[v] - early.position[v]).norm())
                       : kNowhere_mm;
  std::vector<double> result(film.u.size(), 0);
  parallel_for(result.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const FilmLocation at = locate_flat(*coarse, film.u[v]);
      if (at.triangle < 0) continue;
      const Triangle& corner = coarse->triangles[std::size_t(at.triangle)];
      for (std::size_t k = 0; k < 3; ++k)
        result[v] += at.weight[Eigen::Index(k)] * moved[std::size_t(corner[k])];
      result[v] = std::max(0.0, result[v]);
    }
  });
  return result;
}

}  // namespace hydrodip
