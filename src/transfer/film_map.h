// Film point <-> object point: the map that the dip left behind (paper section 3.3, per point).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "film/film.h"
#include "object/object.h"
#include "object/surface.h"

namespace hydrodip {

// A triangle of film on the object: its plane, and lines from there to the object. A point of it
// that is more than 0 beyond what is promised is torn (DippedFilm::excess).
struct LyingTriangle {
  std::array<Vec2, 3> film_mm;
  std::array<Vec3, 3> position, direction;  // directions between corners are not of unit length
  std::array<double, 3> excess, area_ratio;
};

// Immutable once built, safe to query from many threads; keeps references to all three arguments.
class FilmMap {
 public:
  FilmMap(const TriangleMesh& object, const Surface& surface, const DippedFilm& film);
  ~FilmMap();
  FilmMap(FilmMap&&) noexcept;
  FilmMap& operator=(FilmMap&&) noexcept;

  // Where the last query ended: makes queries at neighbouring points fast. One per thread of work;
  // start with a fresh one where results must not depend on how the work was divided.
  struct Cursor {
    std::int32_t film_triangle = -1;
    int object_triangle = -1;
  };

  // Point on the object where film coordinate u (mm) ends up; nothing if no film lies there.
  std::optional<SurfacePoint> to_object(const Vec2& u, Cursor& cursor) const;
  std::optional<SurfacePoint> to_object(const Vec2& u) const;

  // What to_object is made of: the triangles of film that lie on the object, at least in part, and
  // how far from film along its line the object may be.
  const std::vector<std::int32_t>& lying() const;
  LyingTriangle lying(std::int32_t film_triangle) const;
  double reach_mm() const;
  const TriangleMesh& object() const;
  const Surface& surface() const;

  // Film coordinate (mm) that lands at a point of the object; nothing if it stays bare.
  std::optional<Vec2> to_film(const Vec3& position, const Vec3& normal) const;
  // The same along the normal of the point's triangle, for many points: faster.
  std::optional<Vec2> to_film(const SurfacePoint& point) const;

  // Whether torn film lies at a point of the object, where to_film has nothing.
  bool torn_at(const Vec3& position, const Vec3& normal) const;

  // What is to be expected of the film at a point of the object, printed or not.
  struct Hold {
    double stretch = 1;   // largest principal
    double moved_mm = 0;  // how far it lies elsewhere if torn film falls another way
    bool whole = true;    // to_film has it
    bool let_go = false;  // none of it is left there
  };
  // Nothing where no film lies that is worth a word.
  std::optional<Hold> hold_at(const Vec3& position, const Vec3& normal) const;
  // What to_film and hold_at say, in one look.
  struct Lying {
    std::optional<Vec2> film;
    std::optional<Hold> hold;
  };
  Lying lying_at(const Vec3& position, const Vec3& normal) const;
  Lying lying_at(const SurfacePoint& point) const;

  // Interpolated between the film's vertices; 1 off the object.
  double area_ratio(const Vec2& u) const;  // deformed over flat area
  double area_ratio(const Vec2& u, Cursor& cursor) const;
  double stretch(const Vec2& u) const;  // largest principal stretch

  // Bounds of the film that lies on the object, in u.
  const Box2& covered() const;
  // Nearest film point that lies on the object, if within max_distance of u.
  std::optional<Vec2> nearest_covered(const Vec2& u, double max_distance) const;
  std::optional<Vec2> nearest_covered(const Vec2& u, double max_distance, Cursor& cursor) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydrodip
