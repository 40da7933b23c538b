// Where a simulated dip lays the board's corners: all that a calibration asks of a simulation, and
// the same for every scan of an object.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibrate/checkerboard_dip.h"

namespace hydrodip {

// One corner on the object.
struct Landing {
  Vec3 position;                        // mm, posed object
  Eigen::Matrix<double, 3, 2> by_film;  // how far it moves with the point of the film
};

// How far the film's point moves with the one on the object; across the surface it does not.
Eigen::Matrix<double, 2, 3> by_object(const Landing& landing);

// Corners with places from -reach to reach, row by row; nothing where a corner stays off the
// object.
struct Landings {
  GridPlace reach{0, 0};
  std::vector<std::optional<Landing>> corner;

  const Landing* find(const GridPlace& place) const;   // nullptr: stays off, or out of reach
  std::size_t index_of(const GridPlace& place) const;  // within reach
};

Landings landings_of(const CheckerboardDip& dip, const CalibrationObject& object,
                     const GridPlace& reach);

}  // namespace hydrodip
