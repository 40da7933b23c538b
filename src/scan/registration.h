// A scan brought into the posed-object frame by a rigid motion.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "film/film.h"
#include "object/surface.h"
#include "scan/corner_grid.h"

namespace hydrodip {

// Where the printed corner of an absolute place (columns and rows of the board, from its centre)
// lies on the object, by a simulation; nothing if it stays off the object.
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

// How far from the centre corners can be on a sheet.
GridPlace reach_of(const FilmOptions& film, double square_mm);

// Tries every quarter turn and shift of the largest patch on the film. `reach` bounds the places
// that can land: columns and rows from -reach to reach. Throws InputError (naming `name`) if fewer
// than 6 corners hang together or nothing fits to half a square.
GridMatch match_grid(const CornerGrid& grid, const GridLanding& landing, const GridPlace& reach,
                     double square_mm, const std::string& name);

// Absolute places for the corners that have none yet, patch by patch, once the scan lies in the
// posed-object frame: the quarter turn and shift with which a patch lies nearest to where its
// corners land. None for a patch that nowhere comes as near as half a square.
void place_patches(const CornerGrid& grid, const Eigen::Isometry3d& pose, bool turned,
                   const GridLanding& landing, const GridPlace& reach, double square_mm,
                   std::vector<std::optional<GridPlace>>& place);

// Why no patch of a scan that lies in the posed-object frame already has a place: how far its
// corners are from the board's nearest ones, and what that means. A sentence's end, for after the
// file's name.
std::string why_unplaced(const CornerGrid& grid, const Surface& surface, const GridLanding& landing,
                         const GridPlace& reach, double square_mm);

// Moves the pose by a small turn about the origin (rad) and a shift (mm).
Eigen::Isometry3d moved_a_little(const Eigen::Isometry3d& pose, const Vec3& shift,
                                 const Vec3& turn);

// The motion that takes `from` to `to` (columns) with the least squares.
Eigen::Isometry3d rigid_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

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
