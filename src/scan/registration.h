// A scan brought into the posed-object frame by a rigid motion.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "object/surface.h"
#include "scan/corner_grid.h"

namespace hydrodip {

// Where the printed corner of an absolute place (square * place on the film, from its centre) lies
// on the object, by a simulation; nothing if it stays off the object.
using GridLanding = std::function<std::optional<Vec3>(const GridPlace&)>;

// How a scan's own rows and columns lie on the film.
struct GridMatch {
  // Absolute places of the largest patch's corners; of others none.
  std::vector<std::optional<GridPlace>> place;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // scan to posed object, roughly
  double rms_mm = 0;                                       // of the corners from where they land
  // The rows run the other way round than the scan's faces say. On an object that is its own mirror
  // image that comes to the same; on others see mirrored.
  bool turned = false;
  bool mirrored = false;  // only the scan's mirror image fits the object
};

// Tries every quarter turn and shift of the largest patch on the film. `reach` bounds the places
// that can land: columns and rows from -reach to reach. Throws InputError (naming `name`) if fewer
// than 6 corners hang together or nothing fits to half a square.
GridMatch match_grid(const CornerGrid& grid, const GridLanding& landing, const GridPlace& reach,
                     double square_mm, const std::string& name);

struct Alignment {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // scan to posed object
  double rms_mm = 0;                                       // of the corners from the surface
  double worst_mm = 0;  // largest distance of a corner from the surface
};

// The rigid motion, near match.pose, that brings all corners as near to the surface as possible.
// Where the surface leaves it open (a sphere's turns), the corners come to lie where they land.
Alignment align(const CornerGrid& grid, const GridMatch& match, const Surface& surface,
                const GridLanding& landing);

// How far the corners of an already aligned scan lie from the surface.
Alignment as_it_lies(const CornerGrid& grid, const Surface& surface);

CornerGrid moved(const CornerGrid& grid, const Eigen::Isometry3d& pose);

}  // namespace hydrodip
