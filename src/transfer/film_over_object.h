// The film over each triangle of the object, triangle on triangle: sample_landings from the other
// side.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "object/object.h"
#include "object/surface.h"

namespace hydrodip {

// Along the normal of a triangle of the object, where a triangle of film is met changes linearly
// from point to point. So each of the object's that is asked for keeps those few functions, instead
// of following two rays for each of its points. Safe to ask from many threads; refers to all that
// it is made from.
class FilmOverObject {
 public:
  // Of film within `reach_mm` on either side; `sheet`: its surface.
  FilmOverObject(const TriangleMesh& object, const TriangleMesh& film, const Surface& sheet,
                 double reach_mm);
  ~FilmOverObject();
  FilmOverObject(const FilmOverObject&) = delete;
  FilmOverObject& operator=(const FilmOverObject&) = delete;

  struct Nearest {
    bool is_known = false;  // else rays have to tell: film there is much finer than the object, or
                            // the object so fine that few of its triangles are asked for twice
    std::optional<SurfaceHit> hit;
  };
  // The nearer one of what is met first on either side, if its upper side lies against the object;
  // t: how far away. Of equally near ones that on the inside.
  Nearest nearest(const SurfacePoint& point) const;

 private:
  // From the object triangle's first corner to the others.
  struct Linear {
    float first = 0, by_u = 0, by_v = 0;
    float at(float u, float v) const { return first + u * by_u + v * by_v; }
    float least() const;
    float most() const;
  };
  struct Over {
    std::int32_t triangle = -1;
    bool is_against = false;  // the object: with its upper side
    Linear u, v;              // barycentric, of film
    Linear way_mm;            // along the object's normal
  };
  using Overs = std::vector<Over>;

  const Overs& over(int object_triangle) const;
  std::unique_ptr<const Overs> find(int object_triangle) const;

  const TriangleMesh& object_;
  const TriangleMesh& film_;
  const Surface& sheet_;
  const double reach_mm_;
  mutable std::vector<std::atomic<const Overs*>> found_;  // per object triangle, or empty
};

}  // namespace hydrodip
