#include "calibrate/search.h"
#include "calibrate/resolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "calibrate/misfit.h"

namespace hydrodip {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// A dip that misses more than this share of the corners that others have is no candidate.
constexpr double kLeastShare = 0.8;
// Widest stencil of the refinement, and the distance of its lattice's nodes.
const FitPoint kWidestStep(0.03, 0.1, 0.06);
// By how much answers are led astray beyond what finer film says, as seen on scans from films of
// nine times the triangles (docs/calibration.md): z_stretch, share of 1 / sqrt(ratio), poisson.
constexpr double kAstray[3] = {0.0015, 0.03, 0.025};
// Rounds of a refinement; a scan alone is read off the last stencil of all, which costs nothing.
constexpr int kRounds = 8, kRoundsAlone = 1;

DesignOptions grid_design(const DesignOptions& design, const GridSearchOptions& options) {
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

// By the dip that reaches most of a scan's corners. What hangs together with none of these has no
// place on the board. A row of results is of all subjects.
CornersWithoutFilm without_film(const Subject& subject, const std::vector<SimulationResult>& rows,
                                std::size_t column, std::size_t columns) {
  CornersWithoutFilm least{subject.place.size(), subject.place.size()};
  for (std::size_t i = column; i < rows.size(); i += columns) {
    if (!rows[i]) continue;
    const auto bare = std::size_t(std::ranges::count_if(subject.place, [&](const auto& place) {
      return !place || rows[i]->find(*place) == nullptr;
    }));
    least.bare = std::min(least.bare, bare);
  }
  return least;
}

double sum_of_squares(const std::vector<double>& errors, const std::vector<std::size_t>& which) {
  double sum = 0;
  for (const std::size_t i : which) sum += errors[i] * errors[i];
  return sum;  // NaN if one is missing
}

// Eq. 4's lengths of a scan carried back by a simulated dip.
std::vector<LengthError> length_errors_by(const Subject& subject, const Board& board,
                                          const SimulationResult& result) {
  if (!result) return {};
  return length_errors(subject.lengths, warped_near(subject, board, *result), board.square_mm);
}

// The same by the subject's lengths; NaN where the dip does not know one.
std::vector<double> lengths_by(const Subject& subject, const Board& board,
                               const SimulationResult& result) {
  std::optional<WarpedGrid> warped;
  if (result) warped = warped_near(subject, board, *result);
  return errors_by_length(subject, warped, board.square_mm);
}

std::vector<std::size_t> all_indices(std::size_t count) {
  std::vector<std::size_t> list(count);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

std::vector<SimulationRequest> requests_at(const FitPoint& point,
                                           const std::vector<std::size_t>& subjects) {
  std::vector<SimulationRequest> requests;
  requests.reserve(subjects.size());
  for (const std::size_t s : subjects) requests.push_back({s, from_fit(point)});
  return requests;
}

// What a corner's three rows may be wrong by after a correction, as noise: its doubt, which corners
// along an object's edge have in common, so that many of them say no more than one.
Eigen::VectorXd uncertainty(const Correction& correction) {
  constexpr double kAlike = 5;  // square root of how many
  Eigen::VectorXd result(correction.doubt.size());
  for (Eigen::Index i = 0; i < result.size(); i += 3)
    result.segment<3>(i).setConstant(kAlike * correction.doubt.segment<3>(i).norm());
  return result;
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

}  // namespace

std::vector<FilmParameters> grid_points(const GridSearchOptions& options) {
  std::vector<FilmParameters> points;
  for (const double z : options.z_stretch)
    for (const double ratio : options.stiffness_ratio)
      for (const double poisson : options.poisson) points.push_back({z, ratio, poisson});
  return points;
}

Search::Search(const std::vector<Subject>& subjects, const DesignOptions& design,
               const Board& board, const GridSearchOptions& options, SimulationStore& store)
    : subjects_(subjects),
      options_(options),
      board_(board),
      same_film_(options.elements_factor == 1 && options.step_factor == 1),
      store_(store),
      design_(design),
      grid_film_(subjects, grid_design(design, options), board,
                 fmt::format("grid-{:g}-{:g}", options.elements_factor, options.step_factor),
                 store),
      film_(subjects, design, board, "film", store),
      finer_film_(subjects, finer_film(design), checkered_film(design, board, 1), "finer", store) {}

namespace {

std::vector<SimulationRequest> grid_requests(const GridSearchOptions& options,
                                             std::size_t subjects) {
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
  grid_film_.get(mine, "searching", context);
}

std::size_t Search::missing() const {
  return grid_film_.missing(grid_requests(options_, subjects_.size()));
}

std::vector<GridPointError> Search::grid_errors(const RunContext& context) {
  const std::vector<FilmParameters> points = grid_points(options_);
  const std::vector<SimulationResult> results =
      grid_film_.get(grid_requests(options_, subjects_.size()), "searching", context);
  std::vector<GridPointError> grid;
  grid.reserve(points.size());
  for (const FilmParameters& parameters : points)
    grid.push_back({parameters, std::vector<double>(subjects_.size(), kNaN), 0});
  std::vector<double> sums(points.size(), 0);
  double count = 0;
  compared_.clear();
  for (std::size_t s = 0; s < subjects_.size(); ++s) {
    std::vector<std::vector<double>> rows(points.size());
    parallel_for(points.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        rows[p] = lengths_by(subjects_[s], board_, results[p * subjects_.size() + s]);
    });
    require_film_on_most(subjects_[s], without_film(subjects_[s], results, s, subjects_.size()),
                         context);
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

Misfits Search::misfits_at(Simulations& simulations, const std::vector<std::size_t>& subjects,
                           const std::vector<FitPoint>& points, const std::string& activity,
                           std::vector<Vec2>& film_off_mm, const RunContext& context) {
  std::vector<SimulationRequest> requests;
  for (const FitPoint& point : points)
    for (const std::size_t s : subjects) requests.push_back({s, from_fit(point)});
  const std::vector<SimulationResult> results = simulations.get(requests, activity, context);
  std::vector<Misfits> parts;
  Eigen::Index rows = 0, open = 0;
  film_off_mm.clear();
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    std::vector<const Landings*> dips;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const SimulationResult& result = results[p * subjects.size() + i];
      dips.push_back(result ? &*result : nullptr);
    }
    ScanMisfits found = misfits_of(subjects_[subjects[i]], board_, dips);
    film_off_mm.push_back(found.film_off_mm);
    parts.push_back(std::move(found.misfits));
    rows += parts.back().value.rows();
    open += parts.back().open.cols();
  }
  Misfits all = {Eigen::MatrixXd(rows, Eigen::Index(points.size())),
                 Eigen::MatrixXd::Zero(rows, open)};
  rows = open = 0;
  for (const Misfits& part : parts) {
    all.value.middleRows(rows, part.value.rows()) = part.value;
    all.open.block(rows, open, part.open.rows(), part.open.cols()) = part.open;
    rows += part.value.rows();
    open += part.open.cols();
  }
  return all;
}

FitPoint Search::rough_answer(const std::vector<std::size_t>& subjects, const FitPoint& start,
                              const RunContext& context) {
  std::vector<Vec2> film_off_mm;
  FitOptions options = fit_options();
  options.rounds_max = kRounds;
  return fit_parameters(
             start,
             [&](const std::vector<FitPoint>& points) {
               Misfits misfits =
                   misfits_at(grid_film_, subjects, points, "refining", film_off_mm, context);
               // Coarse films take hard ink for soft: without this they lead far astray.
               if (options_.correct) {
                 const Eigen::VectorXd change =
                     change_at(points.front(), grid_film_, film_, subjects, context);
                 misfits.value.colwise() += change;
                 misfits.uncertain_mm = uncertainty(correction(change));
               }
               return misfits;
             },
             options)
      .point;
}

Answer Search::answer(const std::string& name, const std::vector<std::size_t>& subjects,
                      const FitPoint& start, int rounds, const RunContext& context) {
  Answer result;
  result.name = name;
  FitOptions options = fit_options();
  options.rounds_max = rounds;
  options.polished = options_.correct && rounds > kRoundsAlone;
  Correction lacking;
  result.fit = fit_parameters(
      start,
      [&](const std::vector<FitPoint>& points) {
        Misfits misfits =
            misfits_at(film_, subjects, points, "refining", result.film_off_mm, context);
        if (!options_.correct) return misfits;
        lacking = correction(change_at(points.front(), film_, finer_film_, subjects, context));
        misfits.value.colwise() += lacking.all;
        misfits.uncertain_mm = uncertainty(lacking);
        return misfits;
      },
      options);
  result.parameters = from_fit(result.fit.point);
  result.certainty = certainty(
      result.fit, lacking.doubt,
      options_.correct ? FitPoint(kAstray[0], kAstray[1] * result.fit.point[1], kAstray[2])
                       : FitPoint::Zero());
  result.correction_mm = root_mean_square(lacking.all);
  result.by_ink = misfits_by_ink(result.fit, subjects, context);
  return result;
}

// Read off on the film, by the map of the dip at the fit's centre.
std::vector<InkMisfit> Search::misfits_by_ink(const FilmFit& fit,
                                              const std::vector<std::size_t>& subjects,
                                              const RunContext& context) {
  const std::vector<SimulationResult> dips =
      film_.get(requests_at(fit.center, subjects), "refining", context);
  std::map<std::uint8_t, std::vector<double>> by_ink;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    std::map<GridPlace, Vec2> off;  // of a corner, on the film
    for (const auto& place : subjects_[subjects[i]].place) {
      const Vec3 misfit = fit.residual.segment<3>(row);
      row += 3;
      const Landing* landing = place && dips[i] ? dips[i]->find(*place) : nullptr;
      if (landing != nullptr && misfit.allFinite()) off[*place] = by_object(*landing) * misfit;
    }
    for (const auto& [place, low] : off) {
      const auto right = off.find({place[0] + 1, place[1]});
      const auto up = off.find({place[0], place[1] + 1});
      const auto far = off.find({place[0] + 1, place[1] + 1});
      if (right == off.end() || up == off.end() || far == off.end()) continue;
      const double longer = 0.25 * ((right->second - low).x() + (far->second - up->second).x() +
                                    (up->second - low).y() + (far->second - right->second).y());
      by_ink[board_.ink_of(place)].push_back(longer / board_.square_mm);
    }
  }
  std::vector<InkMisfit> list;
  for (const auto& [ink, values] : by_ink) {
    const auto count = double(values.size());
    double mean = 0, spread = 0;
    for (const double value : values) mean += value / count;
    for (const double value : values) spread += (value - mean) * (value - mean);
    const double deviation = count > 1 ? std::sqrt(spread / (count - 1) / count) : 0;
    list.push_back({ink / 255.0, values.size(), mean, deviation});
  }
  return list;
}

// From dips at the fit's centre in which one ink after the other is stiffer.
StiffnessTable Search::stiffness_of_inks(const FilmFit& fit,
                                         const std::vector<std::size_t>& subjects,
                                         const RunContext& context) {
  constexpr double kStiffer = 1.3, kLeastRatio = 1.1;
  const double ratio = from_fit(fit.center).stiffness_ratio;
  std::vector<double> densities;
  for (const std::uint8_t ink : std::set<std::uint8_t>(board_.ink.begin(), board_.ink.end()))
    if (ink > 0) densities.push_back(ink / 255.0);
  if (ratio < kLeastRatio) return {};
  std::vector<Vec2> film_off_mm;
  const Misfits here =
      misfits_at(film_, subjects, {fit.center}, "weighing inks", film_off_mm, context);
  Eigen::MatrixXd by_ink(here.value.rows(), Eigen::Index(densities.size()));
  for (std::size_t i = 0; i < densities.size(); ++i) {
    Simulations bent(subjects_, design_,
                     with_ink_stiffer(film_.film(), densities, i, kStiffer, ratio),
                     fmt::format("film-ink-{:g}", densities[i]), store_);
    const Misfits there =
        misfits_at(bent, subjects, {fit.center}, "weighing inks", film_off_mm, context);
    by_ink.col(Eigen::Index(i)) = (there.value - here.value) / std::log(kStiffer);
  }
  // As the fit's own rows: what nobody has measured is left out of them.
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < by_ink.rows(); ++row)
    if (std::isfinite(fit.residual[row]) && by_ink.row(row).allFinite() &&
        (here.open.cols() == 0 || here.open.row(row).allFinite()))
      rows.push_back(row);
  const Eigen::VectorXd weight = weights_of(fit, rows);
  const Eigen::MatrixXd left =
      weight.cwiseInverse().asDiagonal() *
      without(weight.asDiagonal() * by_ink(rows, Eigen::all),
              orthonormal(weight.asDiagonal() * here.open(rows, Eigen::all)));
  by_ink.setConstant(kNaN);
  for (std::size_t i = 0; i < rows.size(); ++i) by_ink.row(rows[i]) = left.row(Eigen::Index(i));
  return stiffness_table(fit, densities, by_ink);
}

// Differences of landings, for the scan's corners.
Eigen::VectorXd Search::change_at(const FitPoint& point, Simulations& film, Simulations& finer,
                                  const std::vector<std::size_t>& subjects,
                                  const RunContext& context) {
  const std::vector<SimulationRequest> requests = requests_at(point, subjects);
  const std::vector<SimulationResult> here = film.get(requests, "correcting", context);
  const std::vector<SimulationResult> there = finer.get(requests, "correcting", context);
  std::vector<double> change;
  for (std::size_t i = 0; i < subjects.size(); ++i)
    for (const auto& place : subjects_[subjects[i]].place) {
      const Landing* a = place && here[i] ? here[i]->find(*place) : nullptr;
      const Landing* b = place && there[i] ? there[i]->find(*place) : nullptr;
      const bool known = a != nullptr && b != nullptr;
      for (int k = 0; k < 3; ++k) change.push_back(known ? a->position[k] - b->position[k] : kNaN);
    }
  return Eigen::Map<Eigen::VectorXd>(change.data(), Eigen::Index(change.size()));
}

Answer Search::fit_from(const FilmParameters& start, const RunContext& context) {
  const std::vector<std::size_t> everyone = all_indices(subjects_.size());
  FitPoint from = to_fit(start);
  if (!same_film_) from = rough_answer(everyone, from, context);
  return answer("all", everyone, from, kRounds, context);
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
  result.all = fit_from(best->parameters, context);
  result.correction_mm = result.all.correction_mm;
  result.stiffness = stiffness_of_inks(result.all.fit, everyone, context);

  FitPoint sum = FitPoint::Zero();
  for (const std::size_t s : everyone) {
    result.each.push_back(
        subjects_.size() == 1
            ? result.all
            : answer(subjects_[s].name, {s}, result.all.fit.point, kRoundsAlone, context));
    result.each.back().name = subjects_[s].name;
    sum += result.each.back().fit.point;
  }
  result.average = from_fit(sum / double(subjects_.size()));

  std::vector<SimulationRequest> last;
  last.reserve(everyone.size());
  for (const std::size_t s : everyone) last.push_back({s, result.all.parameters});
  const std::vector<SimulationResult> ends = film_.get(last, "measuring", context);
  for (const std::size_t s : everyone)
    result.error.push_back(
        grid_error(length_errors_by(subjects_[s], board_, ends[s]), board_.square_mm));
  result.simulations = store_.size();
  return result;
}

}  // namespace hydrodip
