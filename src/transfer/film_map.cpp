#include "transfer/film_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "film/film_normals.h"
#include "film/locate.h"
#include "transfer/covered_rim.h"
#include "transfer/film_over_object.h"

namespace hydrodip {

namespace {

constexpr double kInside = -1e-9;

std::vector<std::int32_t> lying_on_object(const DippedFilm& film) {
  std::vector<std::int32_t> lying;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t)
    if (film.lies_on_object(t)) lying.push_back(std::int32_t(t));
  return lying;
}

// What would lie on the object had it not torn.
std::vector<std::int32_t> torn_on_object(const DippedFilm& film) {
  std::vector<std::int32_t> torn;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    const Triangle& corners = film.mesh().triangles[t];
    const bool attached = std::all_of(corners.begin(), corners.end(), [&](std::int32_t v) {
      return film.state[std::size_t(v)] == VertexState::kAttached;
    });
    if (film.torn[t] && attached) torn.push_back(std::int32_t(t));
  }
  return torn;
}

std::vector<Triangle> corners_of(const std::vector<std::int32_t>& triangles,
                                 const DippedFilm& film) {
  std::vector<Triangle> corners;
  corners.reserve(triangles.size());
  for (const std::int32_t t : triangles) corners.push_back(film.mesh().triangles[std::size_t(t)]);
  return corners;
}

// Barycentric coordinates of target in a flat film triangle.
bool weights_in(const FilmMesh& mesh, std::int32_t triangle, const Vec2& target, Vec3& weight) {
  const Triangle& t = mesh.triangles[std::size_t(triangle)];
  const Vec2& a = mesh.u[std::size_t(t[0])];
  const Vec2 ab = mesh.u[std::size_t(t[1])] - a, ac = mesh.u[std::size_t(t[2])] - a;
  const double per_twice = 1 / cross2(ab, ac);
  weight[1] = cross2(target - a, ac) * per_twice;
  weight[2] = cross2(ab, target - a) * per_twice;
  weight[0] = 1 - weight[1] - weight[2];
  return weight.minCoeff() >= kInside;
}

}  // namespace

struct FilmMap::Impl {
  const TriangleMesh& object;
  const Surface& surface;
  const DippedFilm& film;
  std::vector<std::uint8_t> lies;           // per film triangle
  std::vector<std::int32_t> film_triangle;  // of each triangle of film_surface
  std::vector<std::int32_t> torn_triangle;  // of torn_surface
  std::shared_ptr<const TriangleMesh> film_on_object;
  Surface film_surface;      // of film_on_object
  Surface torn_surface;      // torn film, where it met the object
  std::vector<Vec3> normal;  // as DippedFilm::normal
  // Per film triangle: its number among those that are laid over an edge of the object, or -1.
  std::vector<std::int32_t> over_edge;
  std::vector<Vec3> edge_direction;  // of those
  CoveredRim rim;
  double reach_mm;  // how far apart film and object may be: chords against curved surface
  FilmOverObject over_object;

  Impl(const TriangleMesh& o, const Surface& s, const DippedFilm& f)
      : object(o),
        surface(s),
        film(f),
        lies(f.mesh().triangles.size(), 0),
        film_triangle(lying_on_object(f)),
        torn_triangle(torn_on_object(f)),
        film_on_object(std::make_shared<const TriangleMesh>(
            TriangleMesh{f.position, corners_of(film_triangle, f)})),
        film_surface(film_on_object),
        torn_surface(f.position, corners_of(torn_triangle, f)),
        normal(film_normals(f, s)),
        rim(f),
        reach_mm(f.mesh().cell_mm),
        over_object(o, *film_on_object, film_surface, reach_mm) {
    over_edge.assign(film.mesh().triangles.size(), -1);
    for (const std::int32_t t : film_triangle) {
      lies[std::size_t(t)] = 1;
      find_edge(std::size_t(t));
    }
  }

  void find_edge(std::size_t t) {
    const auto direction = direction_over_edge(film, triangle_on_object(film, normal, t), surface);
    if (!direction) return;
    over_edge[t] = std::int32_t(edge_direction.size());
    edge_direction.push_back(*direction);
  }

  bool locate_on_object(const Vec2& u, Cursor& cursor, Vec3& weight) const {
    if (cursor.film_triangle < 0 || !weights_in(film.mesh(), cursor.film_triangle, u, weight)) {
      const FilmLocation at = locate_flat(film.mesh(), u);
      if (!at.inside) return false;
      cursor.film_triangle = at.triangle;
      weight = at.weight;
    }
    return lies[std::size_t(cursor.film_triangle)] != 0 &&
           film.is_whole_at(std::size_t(cursor.film_triangle), weight);
  }

  // Along which film of a triangle is brought onto the object, at one of its corners.
  const Vec3& direction_at(std::int32_t triangle, std::size_t corner) const {
    if (const std::int32_t edge = over_edge[std::size_t(triangle)]; edge >= 0)
      return edge_direction[std::size_t(edge)];
    return normal[std::size_t(film.mesh().triangles[std::size_t(triangle)][corner])];
  }

  struct Line {
    Vec3 point = Vec3::Zero(), direction = Vec3::Zero();
  };
  Line line_at(std::int32_t triangle, const Vec3& weight) const {
    const Triangle& t = film.mesh().triangles[std::size_t(triangle)];
    Line line;
    for (std::size_t k = 0; k < 3; ++k) {
      line.point += weight[Eigen::Index(k)] * film.position[std::size_t(t[k])];
      line.direction += weight[Eigen::Index(k)] * direction_at(triangle, k);
    }
    return line;
  }

  // A line against one triangle of the object; nothing if it all but lies in its plane.
  std::optional<SurfacePoint> project_onto(int triangle, const Line& line) const {
    const Triangle& t = object.triangles[std::size_t(triangle)];
    const Vec3& corner = object.positions[std::size_t(t[0])];
    const Vec3 e1 = object.positions[std::size_t(t[1])] - corner;
    const Vec3 e2 = object.positions[std::size_t(t[2])] - corner;
    const Vec3 p = line.direction.cross(e2);
    const double determinant = e1.dot(p);
    if (!(std::abs(determinant) > 1e-6 * std::sqrt(e1.squaredNorm() * e2.squaredNorm())))
      return std::nullopt;
    const double scale = 1 / determinant;
    const Vec3 s = line.point - corner, q = s.cross(e1);
    const double u = s.dot(p) * scale, v = line.direction.dot(q) * scale;
    if (u < 0 || v < 0 || u + v > 1 || std::abs(e2.dot(q) * scale) > reach_mm) return std::nullopt;
    return SurfacePoint{triangle, u, v};
  }

  std::optional<SurfaceHit> project(const Line& line) const {
    const auto ahead = surface.first_hit(line.point, line.direction, 0, reach_mm);
    const auto behind =
        surface.first_hit(line.point, -line.direction, 0, ahead ? ahead->t : reach_mm);
    if (behind && (!ahead || behind->t < ahead->t)) return behind;
    return ahead;
  }

  // Where a surface made of film lies against the object at one of its points.
  std::optional<SurfaceHit> lying_at(const Surface& sheet, const Vec3& position,
                                     const Vec3& direction) const {
    std::optional<SurfaceHit> best;
    double nearest = reach_mm;
    // Film's chords lie inside of what is rounded: there first, and the other ray is short.
    for (const double side : {-1.0, 1.0}) {
      const auto hit = sheet.first_hit(position, side * direction, 0, nearest);
      // The film's upper side lies against the object: film on the far side of a thin wall, whose
      // upper side looks the other way, is not the film of this point.
      if (!hit || sheet.normal(*hit).dot(direction) >= 0) continue;
      nearest = hit->t;
      best = hit;
    }
    return best;
  }

  struct FilmPoint {
    std::size_t triangle;
    Vec3 weight;
  };
  // The film that lies at a point of the object, whole or not.
  std::optional<FilmPoint> lying_film_at(const Vec3& position, const Vec3& direction) const {
    return lying_film(lying_at(film_surface, position, direction), position);
  }

  // Along the triangle's normal.
  std::optional<FilmPoint> lying_film_at(const SurfacePoint& point) const {
    const FilmOverObject::Nearest nearest = over_object.nearest(point);
    const Vec3 position = position_at(object, point);
    if (nearest.is_known) return lying_film(nearest.hit, position);
    return lying_film_at(position, face_normal(object, point.triangle));
  }

  std::optional<FilmPoint> lying_film(std::optional<SurfaceHit> hit, const Vec3& position) const {
    if (!hit) return std::nullopt;
    // Over an edge film is looked up as to_object() does.
    const std::int32_t edge = over_edge[std::size_t(film_triangle[std::size_t(hit->triangle)])];
    if (edge >= 0)
      if (const auto along = lying_at(film_surface, position, edge_direction[std::size_t(edge)]))
        hit = along;
    return FilmPoint{std::size_t(film_triangle[std::size_t(hit->triangle)]),
                     Vec3(1 - hit->u - hit->v, hit->u, hit->v)};
  }

  // Its film coordinate if it is whole there.
  std::optional<Vec2> whole_film(const std::optional<FilmPoint>& at) const {
    if (!at || !film.is_whole_at(at->triangle, at->weight)) return std::nullopt;
    const Triangle& t = film.mesh().triangles[at->triangle];
    const auto& u = film.mesh().u;
    return Vec2(at->weight[0] * u[std::size_t(t[0])] + at->weight[1] * u[std::size_t(t[1])] +
                at->weight[2] * u[std::size_t(t[2])]);
  }

  // What is to be said of film at a point of the object; `at`: what lies there of what has not
  // torn.
  Lying lying(std::optional<FilmPoint> at, const Vec3& position, const Vec3& direction) const {
    Lying lying{whole_film(at), std::nullopt};
    Hold hold;
    hold.whole = lying.film.has_value();
    if (!at) {
      const auto hit = lying_at(torn_surface, position, direction);
      if (!hit) return lying;
      at = FilmPoint{std::size_t(torn_triangle[std::size_t(hit->triangle)]),
                     Vec3(1 - hit->u - hit->v, hit->u, hit->v)};
    }
    hold.stretch = interpolated(film.stretch, *at);
    if (!film.moved_mm.empty()) hold.moved_mm = interpolated(film.moved_mm, *at);
    hold.let_go = film.torn[at->triangle] &&
                  (film.torn_at_mm.empty() || std::isfinite(film.torn_at_mm[at->triangle]));
    lying.hold = hold;
    return lying;
  }

  double interpolated(const std::vector<double>& value, const FilmPoint& at) const {
    const Triangle& t = film.mesh().triangles[at.triangle];
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += at.weight[Eigen::Index(k)] * value[std::size_t(t[k])];
    return sum;
  }

  // A value that vertices have, at a film coordinate; 1 off the object.
  double interpolated(const std::vector<double>& value, const Vec2& u, Cursor& cursor) const {
    Vec3 weight;
    if (!locate_on_object(u, cursor, weight)) return 1;
    return interpolated(value, {std::size_t(cursor.film_triangle), weight});
  }
};

FilmMap::FilmMap(const TriangleMesh& object, const Surface& surface, const DippedFilm& film)
    : impl_(std::make_unique<Impl>(object, surface, film)) {}
FilmMap::~FilmMap() = default;
FilmMap::FilmMap(FilmMap&&) noexcept = default;
FilmMap& FilmMap::operator=(FilmMap&&) noexcept = default;

std::optional<SurfacePoint> FilmMap::to_object(const Vec2& u, Cursor& cursor) const {
  Vec3 weight;
  if (!impl_->locate_on_object(u, cursor, weight)) return std::nullopt;
  Impl::Line line = impl_->line_at(cursor.film_triangle, weight);
  const double length = line.direction.norm();
  if (length > 1e-6) {
    line.direction /= length;
    if (cursor.object_triangle >= 0)
      if (const auto same = impl_->project_onto(cursor.object_triangle, line)) return same;
    if (const auto hit = impl_->project(line)) {
      cursor.object_triangle = hit->triangle;
      return SurfacePoint{hit->triangle, hit->u, hit->v};
    }
  }
  // Across a sharp edge the interpolated normal may miss; the nearest point is as good as any.
  const auto nearest = impl_->surface.closest_point(line.point, 4 * impl_->reach_mm);
  if (!nearest) return std::nullopt;
  cursor.object_triangle = nearest->triangle;
  return SurfacePoint{nearest->triangle, nearest->u, nearest->v};
}

std::optional<SurfacePoint> FilmMap::to_object(const Vec2& u) const {
  Cursor cursor;
  return to_object(u, cursor);
}

const std::vector<std::int32_t>& FilmMap::lying() const { return impl_->film_triangle; }

LyingTriangle FilmMap::lying(std::int32_t film_triangle) const {
  LyingTriangle lying;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t v = impl_->film.mesh().triangles[std::size_t(film_triangle)][k];
    lying.film_mm[k] = impl_->film.mesh().u[std::size_t(v)];
    lying.position[k] = impl_->film.position[std::size_t(v)];
    lying.direction[k] = impl_->direction_at(film_triangle, k);
    lying.excess[k] = impl_->film.excess_of(v);
    lying.area_ratio[k] = impl_->film.area_ratio[std::size_t(v)];
  }
  return lying;
}

double FilmMap::reach_mm() const { return impl_->reach_mm; }
const TriangleMesh& FilmMap::object() const { return impl_->object; }
const Surface& FilmMap::surface() const { return impl_->surface; }

std::optional<Vec2> FilmMap::to_film(const Vec3& position, const Vec3& normal) const {
  return impl_->whole_film(impl_->lying_film_at(position, normal));
}

std::optional<Vec2> FilmMap::to_film(const SurfacePoint& point) const {
  return impl_->whole_film(impl_->lying_film_at(point));
}

bool FilmMap::torn_at(const Vec3& position, const Vec3& normal) const {
  const auto at = impl_->lying_film_at(position, normal);
  if (at && !impl_->film.is_whole_at(at->triangle, at->weight)) return true;
  return !at && impl_->lying_at(impl_->torn_surface, position, normal).has_value();
}

std::optional<FilmMap::Hold> FilmMap::hold_at(const Vec3& position, const Vec3& normal) const {
  return lying_at(position, normal).hold;
}

FilmMap::Lying FilmMap::lying_at(const Vec3& position, const Vec3& normal) const {
  return impl_->lying(impl_->lying_film_at(position, normal), position, normal);
}

FilmMap::Lying FilmMap::lying_at(const SurfacePoint& point) const {
  return impl_->lying(impl_->lying_film_at(point), position_at(impl_->object, point),
                      face_normal(impl_->object, point.triangle));
}

double FilmMap::area_ratio(const Vec2& u) const {
  Cursor cursor;
  return area_ratio(u, cursor);
}

double FilmMap::area_ratio(const Vec2& u, Cursor& cursor) const {
  return impl_->interpolated(impl_->film.area_ratio, u, cursor);
}

double FilmMap::stretch(const Vec2& u) const {
  Cursor cursor;
  return impl_->interpolated(impl_->film.stretch, u, cursor);
}

const Box2& FilmMap::covered() const { return impl_->rim.covered(); }

std::optional<Vec2> FilmMap::nearest_covered(const Vec2& u, double max_distance) const {
  Cursor cursor;
  return nearest_covered(u, max_distance, cursor);
}

std::optional<Vec2> FilmMap::nearest_covered(const Vec2& u, double max_distance,
                                             Cursor& cursor) const {
  Vec3 weight;
  if (impl_->locate_on_object(u, cursor, weight)) return u;
  return impl_->rim.nearest(u, max_distance);
}

}  // namespace hydrodip
