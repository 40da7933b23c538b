// From scans to film parameters: brute-force grid search, local refinement, correction for the
// film's resolution (paper section 4).
#pragma once

#include <string>
#include <vector>

#include "base/shard.h"
#include "calibrate/fit.h"
#include "calibrate/simulations.h"
#include "calibrate/stiffness_table.h"
#include "calibrate/subject.h"

namespace hydrodip {

struct GridSearchOptions {
  // Values of the grid, ascending; a single one: known, not searched for.
  std::vector<double> z_stretch, stiffness_ratio, poisson;
  // The grid's film: triangles and step of the configuration times these.
  double elements_factor = 0.25;
  double step_factor = 2;
  // For what finer films would change, up to the continuum. Off: the scan was made on the
  // configuration's own film.
  bool correct = true;
};

// The grid's points in the order in which they are computed.
std::vector<FilmParameters> grid_points(const GridSearchOptions& options);

// Eq. 4 over the grid.
struct GridPointError {
  FilmParameters parameters;
  std::vector<double> rms_mm;  // per subject; NaN: no dip, or too few corners
  double all_mm = 0;           // over the lengths of all subjects; NaN likewise
};

// Squares of one ink, as far as a scan has all four corners: how much more they were stretched than
// the answer's dip says. If ink stiffens film as supposed, that is 0 for every ink but for noise.
struct InkMisfit {
  double density = 0;  // 1: a full pass
  std::size_t squares = 0;
  double more_stretch = 0;  // mean, of lengths
  double deviation = 0;     // of that mean
};

// One answer, of all subjects together or of one alone.
struct Answer {
  std::string name;
  FilmParameters parameters;
  FilmFit fit;
  Certainty certainty;
  double correction_mm = 0;       // as the calibration's
  std::vector<InkMisfit> by_ink;  // least ink first
  std::vector<Vec2> film_off_mm;  // per subject: how far the film lay off its place
};

struct Calibration {
  std::vector<GridPointError> grid;
  Answer all;
  std::vector<Answer> each;
  FilmParameters average;    // of each, in FitPoint; the paper's protocol
  StiffnessTable stiffness;  // at the answer of all
  // At the answer of all, on the configuration's own film: per subject.
  std::vector<GridError> error;
  // What the configuration's film lacks: root mean square over all corners' coordinates, mm.
  double correction_mm = 0;
  std::size_t simulations = 0;  // in the store at the end
};

class Search {
 public:
  // Refers to all but the options.
  Search(const std::vector<Subject>& subjects, const DesignOptions& design, const Board& board,
         const GridSearchOptions& options, SimulationStore& store);

  // Simulates the grid, or a shard of it, and keeps the results.
  void simulate_grid(const Shard& shard, const RunContext& context);
  // How many of the grid's simulations the store lacks.
  std::size_t missing() const;

  // Only the answer of all, from near it. Before it, the grid is not needed.
  Answer fit_from(const FilmParameters& start, const RunContext& context);

  // Everything; computes what the store lacks. The result depends on the store only by speed.
  // Throws InputError if no grid point can be dipped.
  Calibration run(const RunContext& context);

 private:
  using Lengths = std::vector<std::vector<std::size_t>>;  // per subject: which are compared

  std::vector<GridPointError> grid_errors(const RunContext& context);
  FitOptions fit_options() const;
  // Of some subjects on one film, one behind the other, as the fit wants them.
  Misfits misfits_at(Simulations& simulations, const std::vector<std::size_t>& subjects,
                     const std::vector<FitPoint>& points, const std::string& activity,
                     std::vector<Vec2>& film_off_mm, const RunContext& context);
  // On the grid's film: good enough to begin from.
  FitPoint rough_answer(const std::vector<std::size_t>& subjects, const FitPoint& start,
                        const RunContext& context);
  std::vector<InkMisfit> misfits_by_ink(const FilmFit& fit,
                                        const std::vector<std::size_t>& subjects,
                                        const RunContext& context);
  // How stiff the board's inks are by themselves. Empty where ink hardly stiffens film.
  StiffnessTable stiffness_of_inks(const FilmFit& fit, const std::vector<std::size_t>& subjects,
                                   const RunContext& context);
  // By how much misfits at a point change from one film to another, finer one.
  Eigen::VectorXd change_at(const FitPoint& point, Simulations& film, Simulations& finer,
                            const std::vector<std::size_t>& subjects, const RunContext& context);
  Answer answer(const std::string& name, const std::vector<std::size_t>& subjects,
                const FitPoint& start, int rounds, const RunContext& context);

  const std::vector<Subject>& subjects_;
  GridSearchOptions options_;
  Board board_;
  bool same_film_;  // the grid's is the configuration's own
  SimulationStore& store_;
  DesignOptions design_;
  Simulations grid_film_;
  Simulations film_;
  Simulations finer_film_;
  Lengths compared_;
};

}  // namespace hydrodip
