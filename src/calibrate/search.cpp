#include "calibrate/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/error.h"

namespace hydrodip {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// A dip that misses more than this share of the corners that others have is no candidate.
constexpr double kLeastShare = 0.8;
// The correction is found anew where the answer moved further than this, in stencils.
constexpr double kMovedFar = 1.0;
constexpr int kMostCorrections = 3;
// Widest stencil of the refinement.
const FitPoint kWidestStep(0.03, 0.1, 0.06);

DesignOptions search_design(const DesignOptions& design, const SearchOptions& options) {
  DesignOptions result = design;
  result.film.elements = std::max(8, int(design.film.elements * options.elements_factor));
  result.dip.step_mm = std::min(10.0, design.dip.step_mm * options.step_factor);
  return result;
}

std::size_t known(const std::vector<double>& errors) {
  return std::size_t(
      std::count_if(errors.begin(), errors.end(), [](double e) { return std::isfinite(e); }));
}

// Lengths that all candidates know, so that every point is judged by the same ones. Candidates are
// the rows with enough of them.
std::vector<std::size_t> common_lengths(const std::vector<std::vector<double>>& rows) {
  std::size_t most = 0;
  for (const auto& row : rows) most = std::max(most, known(row));
  std::vector<std::size_t> common;
  if (most == 0) return common;
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    const bool everywhere = std::all_of(rows.begin(), rows.end(), [&](const auto& row) {
      return double(known(row)) < kLeastShare * double(most) || std::isfinite(row[i]);
    });
    if (everywhere) common.push_back(i);
  }
  return common;
}

double sum_of_squares(const std::vector<double>& errors, const std::vector<std::size_t>& which) {
  double sum = 0;
  for (const std::size_t i : which) sum += errors[i] * errors[i];
  return sum;  // NaN if one is missing
}

std::vector<std::size_t> all_indices(std::size_t count) {
  std::vector<std::size_t> list(count);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

Eigen::MatrixXd with(const Eigen::MatrixXd& errors, const Eigen::VectorXd& correction) {
  return correction.size() == errors.rows() ? (errors.colwise() + correction).eval() : errors;
}

// Of what is known.
double root_mean_square(const Eigen::VectorXd& values) {
  double sum = 0, count = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v * v;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// The part of a correction for all subjects that belongs to one of them; empty if that is.
Eigen::VectorXd part(const Eigen::VectorXd& whole,
                     const std::vector<std::vector<std::size_t>>& compared, std::size_t subject) {
  if (whole.size() == 0) return {};
  Eigen::Index begin = 0;
  for (std::size_t s = 0; s < subject; ++s) begin += Eigen::Index(compared[s].size());
  return whole.segment(begin, Eigen::Index(compared[subject].size()));
}

}  // namespace

std::vector<FilmParameters> grid_points(const SearchOptions& options) {
  std::vector<FilmParameters> points;
  for (const double z : options.z_stretch)
    for (const double ratio : options.stiffness_ratio)
      for (const double poisson : options.poisson) points.push_back({z, ratio, poisson});
  return points;
}

Search::Search(const std::vector<Subject>& subjects, const DesignOptions& design, double square_mm,
               const SearchOptions& options, SimulationStore& store)
    : subjects_(subjects),
      options_(options),
      square_mm_(square_mm),
      store_(store),
      search_film_(subjects, search_design(design, options), square_mm,
                   fmt::format("search-{:g}-{:g}", options.elements_factor, options.step_factor),
                   store),
      fine_film_(subjects, design, square_mm, "fine", store),
      finest_film_(subjects, finer_film(design), square_mm, "finest", store) {}

namespace {

std::vector<SimulationRequest> grid_requests(const SearchOptions& options, std::size_t subjects) {
  std::vector<SimulationRequest> requests;
  for (const FilmParameters& parameters : grid_points(options))
    for (std::size_t s = 0; s < subjects; ++s) requests.push_back({s, parameters});
  return requests;
}

}  // namespace

void Search::simulate_grid(const Shard& shard, const RunContext& context) {
  const std::vector<SimulationRequest> all = grid_requests(options_, subjects_.size());
  std::vector<SimulationRequest> mine;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (shard.has(i)) mine.push_back(all[i]);
  search_film_.get(mine, "searching", context);
}

std::size_t Search::missing() const {
  return search_film_.missing(grid_requests(options_, subjects_.size()));
}

std::vector<GridPointError> Search::grid_errors(const RunContext& context) {
  const std::vector<FilmParameters> points = grid_points(options_);
  const std::vector<SimulationResult> results =
      search_film_.get(grid_requests(options_, subjects_.size()), "searching", context);
  std::vector<GridPointError> grid;
  grid.reserve(points.size());
  for (const FilmParameters& parameters : points)
    grid.push_back({parameters, std::vector<double>(subjects_.size(), kNaN), 0});
  std::vector<double> sums(points.size(), 0);
  double count = 0;
  compared_.clear();
  for (std::size_t s = 0; s < subjects_.size(); ++s) {
    std::vector<std::vector<double>> rows;
    for (std::size_t p = 0; p < points.size(); ++p)
      rows.push_back(errors_by_length(subjects_[s], results[p * subjects_.size() + s], square_mm_));
    compared_.push_back(common_lengths(rows));
    const auto number = double(compared_.back().size());
    if (number < 4)
      throw InputError(fmt::format(
          "{}: no simulated dip lays film on enough of the scanned corners; check the depth ('{}@"
          "DEPTH=...') and --square",
          subjects_[s].file.string(), subjects_[s].object.name));
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double sum = sum_of_squares(rows[p], compared_.back());
      grid[p].rms_mm[s] = std::sqrt(sum / number);
      sums[p] += sum;
    }
    count += number;
  }
  for (std::size_t p = 0; p < points.size(); ++p) grid[p].all_mm = std::sqrt(sums[p] / count);
  return grid;
}

FitOptions Search::fit_options() const {
  const auto& o = options_;
  FitOptions options;
  options.low = to_fit({o.z_stretch.front(), o.stiffness_ratio.back(), o.poisson.front()});
  options.high = to_fit({o.z_stretch.back(), o.stiffness_ratio.front(), o.poisson.back()});
  options.step = kWidestStep;
  return options;
}

Eigen::MatrixXd Search::errors_at(Simulations& simulations,
                                  const std::vector<std::size_t>& subjects,
                                  const std::vector<FitPoint>& points, const std::string& activity,
                                  const RunContext& context) {
  std::vector<SimulationRequest> requests;
  for (const FitPoint& point : points)
    for (const std::size_t s : subjects) requests.push_back({s, from_fit(point)});
  const std::vector<SimulationResult> results = simulations.get(requests, activity, context);
  Eigen::Index rows = 0;
  for (const std::size_t s : subjects) rows += Eigen::Index(compared_[s].size());
  Eigen::MatrixXd errors(rows, Eigen::Index(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      const std::vector<double> all =
          errors_by_length(subjects_[subjects[i]], results[p * subjects.size() + i], square_mm_);
      for (const std::size_t length : compared_[subjects[i]])
        errors(row++, Eigen::Index(p)) = all[length];
    }
  }
  return errors;
}

Correction Search::correction_at(const std::vector<std::size_t>& subjects, const FitPoint& point,
                                 const RunContext& context) {
  const auto errors = [&](Simulations& simulations) -> Eigen::VectorXd {
    return errors_at(simulations, subjects, {point}, "correcting", context).col(0);
  };
  return correction(errors(search_film_), errors(fine_film_), errors(finest_film_));
}

Eigen::MatrixXd Search::noise_gradient(const std::vector<std::size_t>& subjects,
                                       const FitPoint& point, const RunContext& context) {
  Eigen::Index rows = 0, columns = 0;
  for (const std::size_t s : subjects) {
    rows += Eigen::Index(compared_[s].size());
    columns += 3 * Eigen::Index(subjects_[s].scan.grid.position.size());
  }
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(rows, columns);
  Eigen::Index row = 0, column = 0;
  for (const std::size_t s : subjects) {
    const Subject& subject = subjects_[s];
    RunContext quiet = context.quiet();
    const CheckerboardDip dip = search_film_.dip({s, from_fit(point)}, quiet);
    const Comparison comparison = compare(subject, dip);
    gradient.block(row, column, Eigen::Index(compared_[s].size()),
                   3 * Eigen::Index(subject.scan.grid.position.size())) =
        noise_gradient_of(subject, dip, comparison)(compared_[s], Eigen::all);
    row += Eigen::Index(compared_[s].size());
    column += 3 * Eigen::Index(subject.scan.grid.position.size());
  }
  return gradient;
}

LengthErrors Search::errors_with(const std::vector<std::size_t>& subjects,
                                 const Eigen::VectorXd& correction, const RunContext& context) {
  return [this, subjects, correction, &context](const std::vector<FitPoint>& points) {
    return with(errors_at(search_film_, subjects, points, "refining", context), correction);
  };
}

Answer Search::answer(const std::string& name, const std::vector<std::size_t>& subjects,
                      const FitPoint& start, const Eigen::VectorXd& correction,
                      const RunContext& context) {
  Answer result;
  result.name = name;
  result.fit = fit_parameters(start, errors_with(subjects, correction, context), fit_options());
  result.parameters = from_fit(result.fit.point);
  return result;
}

// Takes out what noise does to the answer on average, and says how sure it is. Where the answer is
// at the edge of its range, both start from where noise has driven it beyond.
void Search::judge(Answer& answer, const std::vector<std::size_t>& subjects,
                   const Correction& lacking, const RunContext& context) {
  Fit fit = answer.fit;
  const bool at_edge = fit.at_bound[0] || fit.at_bound[1] || fit.at_bound[2];
  if (at_edge)
    fit = fit_parameters(fit.point, errors_with(subjects, lacking.all, context),
                         without_bounds(fit_options()));
  const auto asked = 1 + 2 * std::count(fit.free.begin(), fit.free.end(), true);
  int known = 0;
  const NoiseGradient gradient = [&](const FitPoint& point) {
    context.progress("weighing noise", double(known++) / double(asked));
    return noise_gradient(subjects, point, context);
  };
  const Eigen::MatrixXd here = gradient(fit.point);
  const double noise_mm = certainty(fit, here).noise_mm;
  const FitPoint step = stencil_step(fit.point, kWidestStep);
  fit.point -= noise_bias(fit, noise_mm, gradient, step);
  answer.certainty = certainty(fit, here, lacking.doubt);
  const FitOptions range = fit_options();
  answer.fit.point = fit.point.cwiseMax(range.low).cwiseMin(range.high);
  answer.parameters = from_fit(answer.fit.point);
}

Calibration Search::run(const RunContext& context) {
  Calibration result;
  result.grid = grid_errors(context);
  const auto best =
      std::min_element(result.grid.begin(), result.grid.end(), [](const auto& a, const auto& b) {
        return !std::isnan(a.all_mm) && (std::isnan(b.all_mm) || a.all_mm < b.all_mm);
      });
  if (std::isnan(best->all_mm))
    throw InputError(
        "at no point of the grid do all objects' dips reach the scanned corners; check the "
        "objects' "
        "depths and the ranges");

  const std::vector<std::size_t> everyone = all_indices(subjects_.size());
  result.all = answer("all", everyone, to_fit(best->parameters), {}, context);
  Correction lacking;
  for (int i = 0; options_.correct && i < kMostCorrections; ++i) {
    const FitPoint before = result.all.fit.point;
    lacking = correction_at(everyone, before, context);
    result.all = answer("all", everyone, before, lacking.all, context);
    const FitPoint moved = (result.all.fit.point - before).cwiseQuotient(kWidestStep);
    if (moved.cwiseAbs().maxCoeff() < kMovedFar) break;
  }
  result.correction_mm = root_mean_square(lacking.all);
  const FitPoint end = result.all.fit.point;
  judge(result.all, everyone, lacking, context);

  FitPoint sum = FitPoint::Zero();
  for (const std::size_t s : everyone) {
    result.each.push_back(
        answer(subjects_[s].name, {s}, end, part(lacking.all, compared_, s), context));
    judge(result.each.back(), {s},
          {part(lacking.all, compared_, s), part(lacking.doubt, compared_, s)}, context);
    sum += result.each.back().fit.point;
  }
  result.average = from_fit(sum / double(subjects_.size()));

  std::vector<SimulationRequest> last;
  last.reserve(everyone.size());
  for (const std::size_t s : everyone) last.push_back({s, result.all.parameters});
  const std::vector<SimulationResult> ends = fine_film_.get(last, "measuring", context);
  for (const std::size_t s : everyone)
    result.error.push_back(grid_error(
        length_errors(subjects_[s].lengths,
                      ends[s].value_or(WarpedGrid(subjects_[s].scan.grid.position.size())),
                      square_mm_),
        square_mm_));
  result.simulations = store_.size();
  return result;
}

}  // namespace hydrodip
