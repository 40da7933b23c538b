// From scans to film parameters: brute-force grid search, local refinement, correction for the
// film's resolution (paper section 4).
#pragma once

#include <string>
#include <vector>

#include "base/shard.h"
#include "calibrate/fit.h"
#include "calibrate/resolution.h"
#include "calibrate/simulations.h"
#include "calibrate/subject.h"

namespace hydrodip {

struct SearchOptions {
  // Values of the grid, ascending; a single one: known, not searched for.
  std::vector<double> z_stretch, stiffness_ratio, poisson;
  // The search's film: triangles and step of the configuration times these.
  double elements_factor = 0.25;
  double step_factor = 2;
  // For what finer films would change, up to the continuum. Off: the scan was made on the search's
  // own film.
  bool correct = true;
};

// The grid's points in the order in which they are computed.
std::vector<FilmParameters> grid_points(const SearchOptions& options);

// Eq. 4 over the grid.
struct GridPointError {
  FilmParameters parameters;
  std::vector<double> rms_mm;  // per subject; NaN: no dip, or too few corners
  double all_mm = 0;           // over the lengths of all subjects; NaN likewise
};

// One answer, of all subjects together or of one alone.
struct Answer {
  std::string name;
  FilmParameters parameters;
  Fit fit;
  Certainty certainty;
};

struct Calibration {
  std::vector<GridPointError> grid;
  Answer all;
  std::vector<Answer> each;
  FilmParameters average;  // of each, in FitPoint; the paper's protocol
  // At the answer of all, on the configuration's own film: per subject.
  std::vector<GridError> error;
  // What the search's coarser film would have changed: root mean square over all lengths, mm.
  double correction_mm = 0;
  std::size_t simulations = 0;  // in the store at the end
};

class Search {
 public:
  // Refers to all but the options.
  Search(const std::vector<Subject>& subjects, const DesignOptions& design, double square_mm,
         const SearchOptions& options, SimulationStore& store);

  // Simulates the grid, or a shard of it, and keeps the results.
  void simulate_grid(const Shard& shard, const RunContext& context);
  // How many of the grid's simulations the store lacks.
  std::size_t missing() const;

  // Everything; computes what the store lacks. The result depends on the store only by speed.
  // Throws InputError if no grid point can be dipped.
  Calibration run(const RunContext& context);

 private:
  using Lengths = std::vector<std::vector<std::size_t>>;  // per subject: which are compared

  std::vector<GridPointError> grid_errors(const RunContext& context);
  FitOptions fit_options() const;
  // Length errors of some subjects on one film, as the fit wants them.
  Eigen::MatrixXd errors_at(Simulations& simulations, const std::vector<std::size_t>& subjects,
                            const std::vector<FitPoint>& points, const std::string& activity,
                            const RunContext& context);
  // Of the search's film at a point.
  Correction correction_at(const std::vector<std::size_t>& subjects, const FitPoint& point,
                           const RunContext& context);
  Answer answer(const std::string& name, const std::vector<std::size_t>& subjects,
                const FitPoint& start, const Eigen::VectorXd& correction,
                const RunContext& context);
  LengthErrors errors_with(const std::vector<std::size_t>& subjects,
                           const Eigen::VectorXd& correction, const RunContext& context);
  void judge(Answer& answer, const std::vector<std::size_t>& subjects, const Correction& lacking,
             const RunContext& context);
  Eigen::MatrixXd noise_gradient(const std::vector<std::size_t>& subjects, const FitPoint& point,
                                 const RunContext& context);

  const std::vector<Subject>& subjects_;
  SearchOptions options_;
  double square_mm_;
  SimulationStore& store_;
  Simulations search_film_;
  Simulations fine_film_;
  Simulations finest_film_;
  Lengths compared_;
};

}  // namespace hydrodip
