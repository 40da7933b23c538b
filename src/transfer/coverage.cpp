#include "transfer/coverage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "film/film_normals.h"

namespace hydrodip {
namespace {

// Vertical walls do not, however they are rounded.
bool meets_face_on(const Vec3& area, const Vec3& direction) {
  return area.squaredNorm() > 0 && faces_down(dip_angle_deg(area.normalized(), direction));
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
    if (direction && meets_face_on(area, *direction)) sum.downward_mm2 += area.norm();
  }
}

// Of a triangle's area, where a function that is linear over it is not above 0.
double share_below(const std::array<double, 3>& corner) {
  const auto above = [](double value) { return value > 0; };
  const auto count = std::count_if(corner.begin(), corner.end(), above);
  if (count == 0 || count == 3) return count == 0 ? 1 : 0;
  // The corner that is alone on its side.
  std::size_t k = 0;
  while (above(corner[k]) != (count == 1)) ++k;
  const auto cut = [&](std::size_t other) { return corner[k] / (corner[k] - corner[other]); };
  const double alone = cut((k + 1) % 3) * cut((k + 2) % 3);
  return count == 1 ? 1 - alone : alone;
}

// Of a film triangle's area: stretched so far that film may tear there, or not know its place, but
// not so far that no film holds.
double doubtful_share(const DippedFilm& film, const Triangle& triangle,
                      const DoubtfulStretch& doubtful) {
  std::array<double, 3> safe{}, held{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = std::size_t(triangle[k]);
    safe[k] = film.stretch[v] - doubtful.from;
    if (!film.moved_mm.empty()) safe[k] = std::max(safe[k], film.moved_mm[v] - kMoved_mm);
    held[k] = film.stretch[v] - doubtful.to;
  }
  return std::max(0.0, share_below(held) - share_below(safe));
}

// Whether a triangle is on the object and has not let go.
bool is_laid(const DippedFilm& film, std::size_t t) {
  if (film.torn[t] && (film.torn_at_mm.empty() || std::isfinite(film.torn_at_mm[t]))) return false;
  const Triangle& corners = film.mesh().triangles[t];
  return std::all_of(corners.begin(), corners.end(), [&](std::int32_t v) {
    return film.state[std::size_t(v)] == VertexState::kAttached;
  });
}

// As it lies on the object, whose normals it has.
class LaidFilm {
 public:
  LaidFilm(const DippedFilm& film, const Surface& surface)
      : film_(film), surface_(surface), normal_(film_normals(film, surface)) {}

  // Of a triangle: where its corners are, and of an edge's two faces each its own part.
  struct Part {
    double mm2 = 0, downward_mm2 = 0;
  };
  Part area(std::size_t t, const Vec3& direction) const {
    const TriangleOnObject on = triangle_on_object(film_, normal_, t);
    if (const auto faces = faces_of(on)) {
      Part sum;
      for (const FacePart& face : *faces) {
        const Vec3 area = area_of(face.corner);
        sum.mm2 += face.share * area.norm();
        if (meets_face_on(-area, direction)) sum.downward_mm2 += face.share * area.norm();
      }
      return sum;
    }
    // Not its own normal, which no chord between places on a round wall keeps upright.
    const Vec3 area = area_of(on.position);
    const auto downward = std::count_if(on.normal.begin(), on.normal.end(), [&](const Vec3& n) {
      return meets_face_on(n.isZero() ? Vec3(-area) : n, direction);
    });
    return {area.norm(), double(downward) / 3 * area.norm()};
  }

 private:
  static Vec3 area_of(const std::array<Vec3, 3>& corner) {
    return 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  }
  std::optional<std::array<FacePart, 2>> faces_of(const TriangleOnObject& on) const {
    const auto direction = direction_over_edge(film_, on, surface_);
    return direction ? parts_over_edge(on.position, on.normal, *direction) : std::nullopt;
  }

  const DippedFilm& film_;
  const Surface& surface_;
  std::vector<Vec3> normal_;
};

void add_doubtful(Coverage& sum, const DippedFilm& film, const LaidFilm& laid,
                  const DoubtfulStretch& doubtful) {
  for (std::size_t t = 0; t < film.mesh().triangles.size() && doubtful.to > 0; ++t) {
    if (!is_laid(film, t)) continue;
    const double share = doubtful_share(film, film.mesh().triangles[t], doubtful);
    if (share > 0) sum.doubtful_mm2 += share * laid.area(t, Vec3(0, 0, -1)).mm2;
  }
}

void add_film(Coverage& sum, const DippedFilm& film, const LaidFilm& laid,
              const DippingDirection& direction_at) {
  double stretch = 0;
  Vec3 lifted = Vec3::Zero();
  double area_ratio = 0;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    const Triangle& triangle = film.mesh().triangles[t];
    const double whole_flat = flat_area(film.mesh(), triangle);
    if (film.torn[t]) sum.torn_mm2 += whole_flat;
    if (!film.lies_on_object(t)) continue;
    const double share = film.whole_part(t).share, flat = share * whole_flat;
    sum.torn_mm2 += whole_flat - flat;
    sum.film_on_object_mm2 += flat;
    const Vec3 at = middle(film.position, triangle);
    auto direction = direction_at(at, 0);
    if (!direction) direction = direction_at(at, kAnyHeight_mm);
    const LaidFilm::Part area = laid.area(t, *direction);
    sum.covered_mm2 += share * area.mm2;
    sum.covered_downward_mm2 += share * area.downward_mm2;
    if (!film.wrinkled.empty() && film.wrinkled[t]) sum.wrinkled_mm2 += share * area.mm2;
    for (const std::int32_t v : triangle) {
      if (film.lifted.empty() || !film.lifted[std::size_t(v)]) continue;
      sum.lifted_mm2 += share * area.mm2 / 3;
      lifted += share * area.mm2 / 3 * film.position[std::size_t(v)];
    }
    for (const std::int32_t v : triangle) {
      stretch += flat / 3 * film.stretch[std::size_t(v)];
      area_ratio += flat / 3 * film.area_ratio[std::size_t(v)];
      if (film.excess_of(v) > 0) continue;
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

double DoubtfulStretch::of(double stretch, double moved_mm) const {
  if (!(to > 0)) return 0;
  const double torn = to > from ? (stretch - from) / (to - from) : stretch > to;
  // Half as doubtful as can be where it is no longer promised.
  return std::clamp(std::max(torn, 0.5 * moved_mm / kMoved_mm), 0.0, 1.0);
}

Coverage measure_coverage(const TriangleMesh& object, const Surface& surface,
                          const DippedFilm& film) {
  return measure_coverage(object, surface, film, straight_down_to(film.depth_mm));
}

Coverage measure_coverage(const TriangleMesh& object, const Surface& surface,
                          const DippedFilm& film, const DippingDirection& direction_at,
                          const DoubtfulStretch& doubtful) {
  Coverage sum;
  const LaidFilm laid(film, surface);
  add_object(sum, object, direction_at);
  add_film(sum, film, laid, direction_at);
  add_doubtful(sum, film, laid, doubtful);
  // Chords of a hollow are longer than its surface.
  sum.covered_mm2 = std::min(sum.covered_mm2, sum.object_mm2);
  sum.covered_downward_mm2 = std::min(sum.covered_downward_mm2, sum.downward_mm2);
  return sum;
}

}  // namespace hydrodip
