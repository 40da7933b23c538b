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

double flat_area(const FilmMesh& mesh, const Triangle& triangle) {
  const Vec2& a = mesh.u[std::size_t(triangle[0])];
  return 0.5 * std::abs(cross2(mesh.u[std::size_t(triangle[1])] - a,
                               mesh.u[std::size_t(triangle[2])] - a));
}

void add_object(Coverage& sum, const TriangleMesh& object, double depth_mm) {
  for (const Triangle& triangle : object.triangles) {
    const Vec3 area = area_vector(object.positions, triangle);
    double height = 0;
    for (const std::int32_t v : triangle) height += object.positions[std::size_t(v)].z() / 3;
    sum.object_mm2 += area.norm();
    if (area.z() < 0 && height <= depth_mm) sum.downward_mm2 += area.norm();
  }
}

void add_film(Coverage& sum, const DippedFilm& film) {
  double stretch = 0;
  double area_ratio = 0;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    const Triangle& triangle = film.mesh().triangles[t];
    const double flat = flat_area(film.mesh(), triangle);
    if (film.torn[t]) sum.torn_mm2 += flat;
    if (!film.lies_on_object(t)) continue;
    const Vec3 area = area_vector(film.position, triangle);
    sum.film_on_object_mm2 += flat;
    sum.covered_mm2 += area.norm();
    if (area.z() > 0) sum.covered_downward_mm2 += area.norm();  // its other side faces down
    for (const std::int32_t v : triangle) {
      stretch += flat / 3 * film.stretch[std::size_t(v)];
      area_ratio += flat / 3 * film.area_ratio[std::size_t(v)];
      sum.stretch_max = std::max(sum.stretch_max, film.stretch[std::size_t(v)]);
      sum.area_ratio_max = std::max(sum.area_ratio_max, film.area_ratio[std::size_t(v)]);
    }
  }
  if (sum.film_on_object_mm2 > 0) {
    sum.stretch_mean = stretch / sum.film_on_object_mm2;
    sum.area_ratio_mean = area_ratio / sum.film_on_object_mm2;
  }
}

}  // namespace

Coverage measure_coverage(const TriangleMesh& object, const DippedFilm& film) {
  Coverage sum;
  add_object(sum, object, film.depth_mm);
  add_film(sum, film);
  // Film that spans an edge of the object counts whole on either side.
  sum.covered_mm2 = std::min(sum.covered_mm2, sum.object_mm2);
  sum.covered_downward_mm2 = std::min(sum.covered_downward_mm2, sum.downward_mm2);
  return sum;
}

}  // namespace hydrodip
