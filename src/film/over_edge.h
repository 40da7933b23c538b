// Film that lies over an edge of the object: flat between corners on two or three of its faces.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "base/math.h"
#include "film/film.h"

namespace hydrodip {

// Whether a point is no further than so many mm from the object's surface.
using NearObject = std::function<bool(const Vec3& point, double within_mm)>;

// Such film is evenly strained if the faces are rolled off into one plane with heights scaled
// (docs/model.md, section 4). So its flat triangle belongs to the faces along the mean of their
// normals, each counted once, in the object so scaled; a direction between the corners' normals, as
// on something round, would crowd it at the edge. `normal`: the object's at each corner, unit,
// outward, or zero; z_stretch: what heights count for. Nothing where the corners lie on one face or
// round, or on faces that do not meet on the object: rough scans and terraces turn everywhere.
std::optional<Vec3> direction_over_edge(const std::array<Vec3, 3>& position,
                                        const std::array<Vec3, 3>& normal, const Vec3& up,
                                        double z_stretch, const NearObject& is_near_object);

// A film triangle as the two functions here take it.
struct TriangleOnObject {
  std::array<Vec3, 3> position, normal;
  Vec3 up;
};

// `normal`: as DippedFilm::normal, which need not be filled.
TriangleOnObject triangle_on_object(const DippedFilm& film, const std::vector<Vec3>& normal,
                                    std::size_t triangle);

// What of the triangle lies on one of two faces.
struct FacePart {
  double share = 0;            // of the film
  std::array<Vec3, 3> corner;  // of the triangle if all of it lay in that face's plane
};

// The two faces' parts, along that direction. Nothing if the corners lie on three faces, or not
// around an edge.
std::optional<std::array<FacePart, 2>> parts_over_edge(const std::array<Vec3, 3>& position,
                                                       const std::array<Vec3, 3>& normal,
                                                       const Vec3& direction);

}  // namespace hydrodip
