#include "transfer/coverage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

Vec3 area_vector(const std::vector<Vec3>& positions, const Triangle& triangle) {
  const Vec3& a = positions[std::size_t(triangle[0])];
  return 0.5 *
         (positions[std::size_t(triangle[1])] - a).cross(positions[std::size_t(triangle[2])] - a);
}

// Film that lies on the object has been in the water, wherever its chords run.
constexpr double kAnyHeight_mm = 1e300;

Vec3 middle(const std::vector<Vec3>& positions, const Triangle& triangle) {
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t v : triangle) sum += positions[std::size_t(v)] / 3;
  return sum;
}

double flat_area(const FilmMesh& mesh, const Triangle& triangle) {
  const Vec2& a = mesh.u[std::size_t(triangle[0])];
  return 0.5 * std::abs(cross2(mesh.u[std::size_t(triangle[1])] - a,
                               mesh.u[std::size_t(triangle[2])] - a));
}

void add_object(Coverage& sum, const TriangleMesh& object, const DippingDirection& direction_at) {
  for (const Triangle& triangle : object.triangles) {
    const Vec3 area = area_vector(object.positions, triangle);
    sum.object_mm2 += area.norm();
    const auto direction = direction_at(middle(object.positions, triangle), 0);
    if (direction && area.dot(*direction) > 0) sum.downward_mm2 += area.norm();
  }
}

void add_film(Coverage& sum, const DippedFilm& film, const DippingDirection& direction_at) {
  double stretch = 0;
  Vec3 lifted = Vec3::Zero();
  double area_ratio = 0;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    const Triangle& triangle = film.mesh().triangles[t];
    const double flat = flat_area(film.mesh(), triangle);
    if (film.torn[t]) sum.torn_mm2 += flat;
    if (!film.lies_on_object(t)) continue;
    const Vec3 area = area_vector(film.position, triangle);
    sum.film_on_object_mm2 += flat;
    sum.covered_mm2 += area.norm();
    // It is its other side that faces down.
    const Vec3 at = middle(film.position, triangle);
    auto direction = direction_at(at, 0);
    if (!direction) direction = direction_at(at, kAnyHeight_mm);
    if (area.dot(*direction) < 0) sum.covered_downward_mm2 += area.norm();
    if (!film.wrinkled.empty() && film.wrinkled[t]) sum.wrinkled_mm2 += area.norm();
    for (const std::int32_t v : triangle) {
      if (film.lifted.empty() || !film.lifted[std::size_t(v)]) continue;
      sum.lifted_mm2 += area.norm() / 3;
      lifted += area.norm() / 3 * film.position[std::size_t(v)];
    }
    for (const std::int32_t v : triangle) {
      stretch += flat / 3 * film.stretch[std::size_t(v)];
      area_ratio += flat / 3 * film.area_ratio[std::size_t(v)];
      sum.stretch_max = std::max(sum.stretch_max, film.stretch[std::size_t(v)]);
      sum.area_ratio_max = std::max(sum.area_ratio_max, film.area_ratio[std::size_t(v)]);
    }
  }
  if (sum.lifted_mm2 > 0) sum.lifted_at = lifted / sum.lifted_mm2;
  if (sum.film_on_object_mm2 > 0) {
    sum.stretch_mean = stretch / sum.film_on_object_mm2;
    sum.area_ratio_mean = area_ratio / sum.film_on_object_mm2;
  }
}

}  // namespace

Coverage measure_coverage(const TriangleMesh& object, const DippedFilm& film) {
  return measure_coverage(object, film, straight_down_to(film.depth_mm));
}

Coverage measure_coverage(const TriangleMesh& object, const DippedFilm& film,
                          const DippingDirection& direction_at) {
  Coverage sum;
  add_object(sum, object, direction_at);
  add_film(sum, film, direction_at);
  // Film that spans an edge of the object counts whole on either side.
  sum.covered_mm2 = std::min(sum.covered_mm2, sum.object_mm2);
  sum.covered_downward_mm2 = std::min(sum.covered_downward_mm2, sum.downward_mm2);
  return sum;
}

}  // namespace hydrodip
