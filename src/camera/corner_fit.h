// How well corners of marks fit what is computed of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "camera/least_squares.h"

namespace hydrodip {

inline constexpr double kCorner_px = 0.1;  // what a corner is known to
// Corners of one camera and one rim that are worse are not of one.
inline constexpr double kWorstFit_px = 1.5;

// At least one value.
double median(std::vector<double> values);

// Of the first so many corners: two residuals each, in units of kCorner_px.
double rms_px(const Fit& fit, std::size_t corners);

// Of each of these corners, whether it lies so much farther off than most that it does not belong
// to what was fitted.
std::vector<std::uint8_t> lies_astray(const Fit& fit, std::size_t corners);

// How much more the residuals scatter than they were said to, as a variance; 1 if nothing tells.
double scatter_of(const Fit& fit);

}  // namespace hydrodip
