#include "job/figures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace hydrodip {
namespace {

constexpr double kSampleSpacing_mm = 1;
constexpr int kMostSamplesPerSide = 200;

struct FaceCoverage {
  double area_mm2 = 0;
  double covered_share = 0;
  bool downward = false;
};

int samples_per_side(double area_mm2) {
  return static_cast<int>(std::clamp(std::ceil(std::sqrt(2 * area_mm2) / kSampleSpacing_mm), 1.0,
                                     double(kMostSamplesPerSide)));
}

// The face is cut into n * n congruent triangles; each counts by its centre.
double covered_share(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal, int n,
                     const FilmMap& map) {
  long covered = 0;
  const auto count = [&](double i, double j) {
    const Vec3 point = a + (b - a) * (i / n) + (c - a) * (j / n);
    if (map.to_film(point, normal)) ++covered;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      count(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 1 < n) count(i + 2.0 / 3, j + 2.0 / 3);
    }
  return double(covered) / (double(n) * n);
}

FaceCoverage face_coverage(const Object& object, std::size_t face, double depth_mm,
                           const FilmMap& map) {
  const auto corner = [&](std::size_t k) -> const Vec3& {
    return object.positions[static_cast<std::size_t>(object.triangles[face][k])];
  };
  const Vec3 &a = corner(0), &b = corner(1), &c = corner(2);
  const Vec3 doubled = (b - a).cross(c - a);
  FaceCoverage coverage;
  coverage.area_mm2 = 0.5 * doubled.norm();
  if (!(coverage.area_mm2 > 0)) return coverage;
  coverage.downward = doubled.z() < 0 && (a.z() + b.z() + c.z()) / 3 <= depth_mm;
  if (std::min({a.z(), b.z(), c.z()}) <= depth_mm)
    coverage.covered_share =
        covered_share(a, b, c, doubled.normalized(), samples_per_side(coverage.area_mm2), map);
  return coverage;
}

void add_coverage(DipFigures& figures, const Object& object, const FilmMap& map, double depth_mm) {
  std::vector<FaceCoverage> faces(object.triangles.size());
  parallel_for(faces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t face = begin; face < end; ++face)
      faces[face] = face_coverage(object, face, depth_mm, map);
  });
  for (const FaceCoverage& face : faces) {
    const double covered = face.area_mm2 * face.covered_share;
    figures.object_mm2 += face.area_mm2;
    figures.covered_mm2 += covered;
    if (!face.downward) continue;
    figures.downward_mm2 += face.area_mm2;
    figures.covered_downward_mm2 += covered;
  }
}

double flat_area(const DippedFilm& film, const Triangle& triangle) {
  const auto u = [&](std::size_t k) -> const Vec2& {
    return film.mesh.u[static_cast<std::size_t>(triangle[k])];
  };
  return 0.5 * cross2(u(1) - u(0), u(2) - u(0));
}

double dipped_area(const DippedFilm& film, const Triangle& triangle) {
  const auto x = [&](std::size_t k) -> const Vec3& {
    return film.position[static_cast<std::size_t>(triangle[k])];
  };
  return 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
}

void add_film(DipFigures& figures, const DippedFilm& film) {
  double dipped_mm2 = 0;
  for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
    const Triangle& triangle = film.mesh.triangles[t];
    if (film.torn[t]) figures.torn_mm2 += flat_area(film, triangle);
    if (!film.lies_on_object(t)) continue;
    figures.film_on_object_mm2 += flat_area(film, triangle);
    dipped_mm2 += dipped_area(film, triangle);
    for (const std::int32_t v : triangle)
      figures.largest_stretch =
          std::max(figures.largest_stretch, film.stretch[static_cast<std::size_t>(v)]);
  }
  if (figures.film_on_object_mm2 > 0)
    figures.mean_area_ratio = dipped_mm2 / figures.film_on_object_mm2;
}

}  // namespace

DipFigures dip_figures(const Object& object, const FilmMap& map, const DippedFilm& film) {
  DipFigures figures;
  add_coverage(figures, object, map, film.depth_mm);
  add_film(figures, film);
  return figures;
}

}  // namespace hydrodip
