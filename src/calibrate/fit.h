// The local refinement: parameters with which a dip lays the corners where the scans have them, and
// how well the scans determine them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "calibrate/checkerboard_dip.h"

namespace hydrodip {

// The parameters as the fit sees them: z_stretch, 1 / sqrt(ratio), poisson. A film's answer to its
// ink saturates as the ink gets stiffer; in 1 / sqrt(ratio) it is nearly straight, and a ratio
// without an upper bound is an interval that reaches 0.
using FitPoint = Eigen::Vector3d;
FitPoint to_fit(const FilmParameters& parameters);
FilmParameters from_fit(const FitPoint& point);

// By how much scanned corners lie elsewhere than simulated ones, mm: a row per coordinate, NaN
// where that is not known.
struct Misfits {
  Eigen::MatrixXd value;  // a column per point
  // Motions of the rows that nobody has measured (misfit.h), at the first point: any amount of
  // them is as good as none. May have no columns.
  Eigen::MatrixXd open;
  // How wrong the simulation itself may be in every row, so that rows which it does not know
  // weigh less. Empty: all alike.
  Eigen::VectorXd uncertain_mm = {};
};
using MisfitsAt = std::function<Misfits(const std::vector<FitPoint>& points)>;

// 97.5 % of the normal distribution.
inline constexpr double kQuantile = 1.96;

struct FitOptions {
  FitPoint low, high;  // where the answer is looked for; equal: fixed
  FitPoint step;       // widest half size of the stencil
  int rounds_max = 12;
  // Whether the answer is put right by the misfits at its own place, which is asked once or twice
  // more: a quadratic model of a wide stencil, and what was found at its centre, are a little off
  // there.
  bool polished = false;
};

// Quadratic in every row: r(d) = r0 + J d + (1/2) sum d_i d_j H_ij, d in stencils.
struct QuadraticModel {
  Eigen::VectorXd value;
  Eigen::MatrixX3d slope;
  Eigen::MatrixXd bend;  // columns: 00, 11, 22, 01, 02, 12

  Eigen::VectorXd at(const Eigen::Vector3d& d) const;
  Eigen::MatrixX3d slope_at(const Eigen::Vector3d& d) const;
};

struct FilmFit {
  FitPoint point = FitPoint::Zero();
  std::array<bool, 3> free{};      // not fixed
  std::array<bool, 3> at_bound{};  // the answer lies at the edge of where it was looked for
  Eigen::VectorXd residual;        // mm, at the answer, without open motions; NaN where not known
  Eigen::MatrixX3d jacobian;       // of the residual, by FitPoint
  Eigen::VectorXd weight;          // of the residual's rows, at most 1; empty: all 1
  std::size_t open = 0;            // how many open motions there were
  int rounds = 0;
  bool settled = false;
  double rms_mm = 0;
  // What the answer was read off: the known rows around a centre, times their weights, or fewer
  // with the same sums of squares.
  QuadraticModel model;
  FitPoint center = FitPoint::Zero(), step = FitPoint::Zero();
  int polishings = 0;
};

// The centre of the stencil that is used at a point: one of a lattice, so that fits that end near
// each other share their simulations; and the stencil's half size there, no wider than `widest`. In
// the ratio both go by what factor they are: a stencil that is wide at soft inks would leave out
// all stiff ones.
FitPoint stencil_center(const FitPoint& point, const FitPoint& widest);
FitPoint stencil_step(const FitPoint& center, const FitPoint& widest);

// Least squares by Levenberg and Marquardt on a quadratic model of every row, made from simulations
// on a stencil of the lattice, until the answer lies in its own stencil. With noise that is alike
// and independent in all rows that is the most likely answer. Rows weigh as if what the simulation
// may lack were noise besides, judging the scan's own by what a fit without weights leaves.
FilmFit fit_parameters(const FitPoint& start, const MisfitsAt& misfits, const FitOptions& options);

// Weights of some of a fit's rows.
Eigen::VectorXd weights_of(const FilmFit& fit, const std::vector<Eigen::Index>& rows);
// How many measurements rows are worth: the sum of their squared weights, less what is fitted.
double freedom_of(const Eigen::VectorXd& weights, double fitted);

// How well the scans determine an answer.
struct Certainty {
  double noise_mm = 0;  // of a corner's coordinate, judged by what the fit leaves
  // Of FitPoint, by noise, from the curvature of the least squares; 0 where fixed.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // 95 % intervals in film parameters. A ratio without upper bound: infinity.
  FilmParameters low, high;
};
// The intervals come from the profile of the likelihood: one parameter held, the others at their
// best, as far as the sum of squares allows. `doubt_mm`: by how much each row may be wrong in
// simulation, all together; what that does to the answer widens the intervals. Empty: nothing.
// `astray`: by how much the answer may be off besides; widens them likewise.
Certainty certainty(const FilmFit& fit, const Eigen::VectorXd& doubt_mm = {},
                    const FitPoint& astray = FitPoint::Zero());

// Two parameters' joint region: by how many of its standard deviations the sum of squares at
// (a, b), the third parameter at its best, is off: up to 2.45 is the 95 % region.
double joint_distance(const FilmFit& fit, double noise_mm, int first, double a, int second,
                      double b);

}  // namespace hydrodip
