// The local refinement: parameters that make the warped grids as regular as they get, and how well
// the scans determine them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "calibrate/checkerboard_dip.h"

namespace hydrodip {

// The parameters as the fit sees them: z_stretch, 1 / sqrt(ratio), poisson. A film's answer to its
// ink saturates as the ink gets stiffer; in 1 / sqrt(ratio) it is nearly straight, and a ratio
// without an upper bound is an interval that reaches 0.
using FitPoint = Eigen::Vector3d;
FitPoint to_fit(const FilmParameters& parameters);
FilmParameters from_fit(const FitPoint& point);

// Length errors (mm) at each of the points, one matrix column per point and the same rows in all;
// NaN where a length is not known there.
using LengthErrors = std::function<Eigen::MatrixXd(const std::vector<FitPoint>& points)>;

struct FitOptions {
  FitPoint low, high;  // where the answer is looked for; equal: fixed
  FitPoint step;       // widest half size of the stencil
  int rounds_max = 12;
};

struct Fit {
  FitPoint point = FitPoint::Zero();
  std::array<bool, 3> free{};      // not fixed
  std::array<bool, 3> at_bound{};  // the answer lies at the edge of where it was looked for
  Eigen::VectorXd residual;        // mm, at the answer; NaN where not known
  Eigen::MatrixX3d jacobian;       // of the residual, by FitPoint
  int rounds = 0;
  bool settled = false;
  double rms_mm = 0;
};

// The same with nothing but what a dip can be computed for as bounds, and few rounds.
FitOptions without_bounds(const FitOptions& options);

// How wide a stencil around a point may be: in the ratio, one that is wide at soft inks would leave
// out all stiff ones.
FitPoint stencil_step(const FitPoint& center, const FitPoint& widest);

// Least squares by Levenberg and Marquardt on a quadratic model of every length, made from
// simulations on a stencil around the last answer, until the answer stays.
Fit fit_parameters(const FitPoint& start, const LengthErrors& errors, const FitOptions& options);

// How a scan's noise shows in the lengths: rows as those of LengthErrors, zero where that is not
// known; a column for each coordinate of each corner.
using NoiseGradient = std::function<Eigen::MatrixXd(const FitPoint& point)>;

// How well the scans determine an answer.
struct Certainty {
  double noise_mm = 0;  // of a corner's coordinate, judged by what the fit leaves
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of FitPoint, by noise; 0 where fixed
  // 95 % intervals in film parameters. A ratio without upper bound: infinity.
  FilmParameters low, high;
};
// `noise_gradient`: at the answer. `doubt_mm`: by how much each length may be wrong in simulation,
// all together; what that does to the answer widens the intervals. Empty: nothing.
Certainty certainty(const Fit& fit, const Eigen::MatrixXd& noise_gradient,
                    const Eigen::VectorXd& doubt_mm = {});

// By how much noise moves an answer on average. The further a simulated film is stretched, the less
// a scan's noise shows in lengths carried back to it, and least squares prefers such a film.
// `step`: over which the noise's gradient is looked at.
FitPoint noise_bias(const Fit& fit, double noise_mm, const NoiseGradient& gradient,
                    const FitPoint& step);

}  // namespace hydrodip
