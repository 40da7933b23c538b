#include "calibrate/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense_solvers.h"
#include "base/error.h"
#include "calibrate/misfit.h"

namespace hydrodip {
namespace {

// What a dip can be computed for, with room for a stencil.
const FitPoint kLeast(0.0, 1e-4, -0.4), kMost(5.0, 1.0, 0.48);
// What a film can be.
const FitPoint kLeastNatural(0.0, 1e-4, 0.0), kMostNatural(5.0, 1.0, 0.48);
// An answer this near to its stencil's centre, in stencils, stays: further than half of the
// lattice's distance, so that it does not go to and fro.
constexpr double kSettled = 0.75;
// How far one round may go, in stencils.
constexpr double kTrust = 1.5;
// This near a bound, in stencils, an answer lies at it.
constexpr double kAtBound = 1e-3;
// Stencils of the ratio: half size over 1 / sqrt(ratio), and least; nodes of the lattice rise by
// this factor.
constexpr double kShareOfRatio = 0.3, kLeastRatioStep = 0.01, kLatticeFactor = 1.3;
// An answer is polished at a point of a lattice a fifth as wide as the stencil: the model
// holds that far, and fits of like scans share their simulations.
constexpr double kPolishingShare = 0.2;
constexpr int kPolishings = 2;

constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

// The same sums of squares from ten rows.
QuadraticModel compressed(const QuadraticModel& model) {
  const Eigen::Index rows = model.value.size();
  if (rows <= 10) return model;
  Eigen::MatrixXd all(rows, 10);
  all << model.value, model.slope, model.bend;
  const Eigen::MatrixXd r = triangular_factor(all);
  return {r.col(0), r.middleCols<3>(1), r.rightCols(6)};
}

// The model's least squares within a box, from `start`: Gauss and Newton's steps, damped as
// Levenberg and Marquardt do, over the parameters that no bound holds. Equal bounds hold a
// parameter.
Eigen::Vector3d minimize(const QuadraticModel& model, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high,
                         const Eigen::Vector3d& start = Eigen::Vector3d::Zero()) {
  constexpr int kMostSteps = 200;
  constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9, kStill = 1e-9;
  Eigen::Vector3d d = start.cwiseMax(low).cwiseMin(high);
  Eigen::VectorXd residual = model.at(d);
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    const Eigen::MatrixX3d slope = model.slope_at(d);
    const Eigen::Vector3d uphill = slope.transpose() * residual;
    Eigen::Matrix3d curvature = slope.transpose() * slope;
    Eigen::Vector3d downhill = -uphill;
    for (int k = 0; k < 3; ++k) {
      const bool held = low[k] == high[k] || (d[k] <= low[k] && uphill[k] > 0) ||
                        (d[k] >= high[k] && uphill[k] < 0);
      curvature(k, k) *= 1 + damping;
      if (!held && curvature(k, k) > 0) continue;
      curvature.row(k).setZero();
      curvature.col(k).setZero();
      curvature(k, k) = 1;
      downhill[k] = 0;
    }
    const Eigen::Vector3d next =
        (d + solve_symmetric(curvature, downhill)).cwiseMax(low).cwiseMin(high);
    const Eigen::VectorXd left = model.at(next);
    if (!(left.squaredNorm() < residual.squaredNorm())) {
      damping *= 10;
      continue;
    }
    const bool still = (next - d).cwiseAbs().maxCoeff() < kStill;
    d = next;
    residual = left;
    damping = std::max(kLeastDamping, 0.1 * damping);
    if (still) break;
  }
  for (int k = 0; k < 3; ++k) {
    if (d[k] < low[k] + kAtBound) d[k] = low[k];
    if (d[k] > high[k] - kAtBound) d[k] = high[k];
  }
  return d;
}

// Ten points that determine a quadratic, or fewer where parameters are fixed.
struct Stencil {
  FitPoint center, step;
  std::array<bool, 3> free;

  FitPoint at(const Eigen::Vector3d& d) const { return center + step.cwiseProduct(d); }

  std::vector<FitPoint> points() const {
    std::vector<FitPoint> list = {center};
    for (int k = 0; k < 3; ++k) {
      if (!free[std::size_t(k)]) continue;
      list.push_back(at(Eigen::Vector3d::Unit(k)));
      list.push_back(at(-Eigen::Vector3d::Unit(k)));
    }
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
      if (free[std::size_t(a)] && free[std::size_t(b)])
        list.push_back(at(Eigen::Vector3d::Unit(a) + Eigen::Vector3d::Unit(b)));
    return list;
  }

  QuadraticModel model(const Eigen::MatrixXd& values) const {
    QuadraticModel m;
    const Eigen::Index rows = values.rows();
    m.value = values.col(0);
    m.slope = Eigen::MatrixX3d::Zero(rows, 3);
    m.bend = Eigen::MatrixXd::Zero(rows, 6);
    Eigen::Index column = 1;
    std::array<Eigen::VectorXd, 3> ahead;
    for (int k = 0; k < 3; ++k) {
      if (!free[std::size_t(k)]) continue;
      ahead[std::size_t(k)] = values.col(column);
      m.slope.col(k) = 0.5 * (values.col(column) - values.col(column + 1));
      m.bend.col(k) = values.col(column) + values.col(column + 1) - 2 * m.value;
      column += 2;
    }
    int pair = 3;
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      if (free[std::size_t(a)] && free[std::size_t(b)])
        m.bend.col(pair) =
            values.col(column++) - ahead[std::size_t(a)] - ahead[std::size_t(b)] + m.value;
      ++pair;
    }
    return m;
  }
};

std::vector<Eigen::Index> known_rows(const Misfits& misfits) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < misfits.value.rows(); ++i)
    if (misfits.value.row(i).allFinite() &&
        (misfits.open.cols() == 0 || misfits.open.row(i).allFinite()))
      rows.push_back(i);
  return rows;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double root_mean_square(const Eigen::VectorXd& values) {
  return values.size() > 0 ? std::sqrt(values.squaredNorm() / double(values.size())) : 0;
}

// The centre of a stencil near a point for which all dips can be computed.
FitPoint inside(const FitPoint& point, const FitPoint& step) {
  return point.cwiseMax(kLeast + step).cwiseMin(kMost - step);
}

Stencil stencil_at(const FitPoint& point, const FitOptions& options,
                   const std::array<bool, 3>& free) {
  const FitPoint center = stencil_center(point, options.step);
  const FitPoint step = stencil_step(center, options.step);
  Stencil stencil{inside(center, step), step, free};
  for (int k = 0; k < 3; ++k)
    if (!free[std::size_t(k)]) stencil.center[k] = point[k];
  return stencil;
}

// ---- one round ----

// A stencil's simulations, and what becomes of them.
class Round {
 public:
  Round(const FitPoint& from, const FitOptions& options, const std::array<bool, 3>& free,
        const MisfitsAt& misfits_at)
      : stencil_(stencil_at(from, options, free)),
        misfits_(misfits_at(stencil_.points())),
        rows_(known_rows(misfits_)),
        low_(in_stencils(options.low).cwiseMax(-Eigen::Vector3d::Constant(kTrust))),
        high_(in_stencils(options.high).cwiseMin(Eigen::Vector3d::Constant(kTrust))) {
    low_ = low_.cwiseMin(high_);
    for (int k = 0; k < 3; ++k)
      if (!free[std::size_t(k)]) low_[k] = high_[k] = 0;
    weight_ = Eigen::VectorXd::Ones(misfits_.value.rows());
    make_model();
    if (misfits_.uncertain_mm.size() > 0) weigh();
  }

  void solve() {
    model_for_answer_ = compressed(model_);
    answer_ = minimize(model_for_answer_, low_, high_);
  }

  // The nearest point of the fine lattice; what is fixed, or at a bound, stays.
  FitPoint polishing_point(const FilmFit& fit) const {
    FitPoint near = fit.point;
    for (int k = 0; k < 3; ++k) {
      const double distance = kPolishingShare * stencil_.step[k];
      if (fit.free[std::size_t(k)] && !fit.at_bound[std::size_t(k)])
        near[k] =
            stencil_.center[k] + distance * std::round((near[k] - stencil_.center[k]) / distance);
    }
    return near;
  }

  // Lets the model say at a point what the misfits there are.
  void put_right(const FitPoint& point, const Misfits& there) {
    for (Eigen::Index i : rows_)
      if (!there.value.row(i).allFinite()) misfits_.value.row(i).setConstant(kNaN);
    rows_ = known_rows(misfits_);
    make_model();
    model_.value += seen(there.value(rows_, 0)) - model_.at(in_stencils(point));
  }

  const Eigen::Vector3d& answer() const { return answer_; }  // in stencils

  void tell(FilmFit& fit, const FitOptions& options) const {
    fit.center = stencil_.center;
    fit.step = stencil_.step;
    fit.open = std::size_t(open_.cols());
    fit.model = model_for_answer_;
    fit.point = stencil_.at(answer_);
    for (int k = 0; k < 3; ++k)
      fit.at_bound[std::size_t(k)] =
          fit.free[std::size_t(k)] &&
          (fit.point[k] <= options.low[k] + 1e-9 || fit.point[k] >= options.high[k] - 1e-9);
    fit.residual = Eigen::VectorXd::Constant(misfits_.value.rows(), kNaN);
    fit.jacobian = Eigen::MatrixX3d::Zero(misfits_.value.rows(), 3);
    fit.weight = weight_;
    const Eigen::VectorXd unweighted = weight_(rows_).cwiseInverse();
    const Eigen::VectorXd residual = unweighted.cwiseProduct(model_.at(answer_));
    const Eigen::MatrixX3d slope = unweighted.asDiagonal() * model_.slope_at(answer_) *
                                   stencil_.step.cwiseInverse().asDiagonal();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      fit.residual[rows_[i]] = residual[Eigen::Index(i)];
      fit.jacobian.row(rows_[i]) = slope.row(Eigen::Index(i));
    }
    fit.rms_mm = root_mean_square(residual);
  }

 private:
  Eigen::Vector3d in_stencils(const FitPoint& point) const {
    return (point - stencil_.center).cwiseQuotient(stencil_.step);
  }

  void make_model() {
    if (rows_.size() < 12)
      throw InputError(
          "the scans have too few corners on the film that the simulation lays down; check the "
          "objects' depths");
    open_ = orthonormal(weight_(rows_).asDiagonal() * misfits_.open(rows_, Eigen::all));
    model_ = stencil_.model(seen(misfits_.value(rows_, Eigen::all)));
  }

  // Weighted, and without what nobody has measured.
  Eigen::MatrixXd seen(const Eigen::MatrixXd& values) const {
    return without(weight_(rows_).asDiagonal() * values, open_);
  }

  void weigh() {
    solve();
    const double noise_mm = root_mean_square(model_.at(answer_));
    if (!(noise_mm > 0)) return;  // all rows agree already
    for (Eigen::Index i : rows_)
      weight_[i] = noise_mm / std::hypot(noise_mm, misfits_.uncertain_mm[i]);
    make_model();
  }

  Stencil stencil_;
  Misfits misfits_;
  std::vector<Eigen::Index> rows_;
  Eigen::VectorXd weight_;
  Eigen::MatrixXd open_;
  QuadraticModel model_, model_for_answer_;  // the latter compressed
  Eigen::Vector3d low_, high_, answer_ = Eigen::Vector3d::Zero();
};

// ---- how well it is known ----

// What a film can be, in stencils of the fit; what is fixed stays.
struct Box {
  explicit Box(const FilmFit& fit)
      : low((kLeastNatural - fit.center).cwiseQuotient(fit.step)),
        high((kMostNatural - fit.center).cwiseQuotient(fit.step)),
        answer((fit.point - fit.center).cwiseQuotient(fit.step)) {
    for (int k = 0; k < 3; ++k)
      if (!fit.free[std::size_t(k)]) low[k] = high[k] = answer[k];
    low = low.cwiseMin(answer);
    high = high.cwiseMax(answer);
  }
  Eigen::Vector3d low, high, answer;
};

// The least sum of squares with some parameters held.
double least_squares(const QuadraticModel& model, Box box, const std::array<bool, 3>& held,
                     const Eigen::Vector3d& at) {
  for (int k = 0; k < 3; ++k)
    if (held[std::size_t(k)]) box.low[k] = box.high[k] = at[k];
  return model.at(minimize(model, box.low, box.high, box.answer)).squaredNorm();
}

// How far one parameter can go to a side, in stencils.
double profile_end(const QuadraticModel& model, const Box& box, int parameter, double side,
                   double first_guess, double allowed) {
  std::array<bool, 3> held{};
  held[std::size_t(parameter)] = true;
  const double bound = side < 0 ? box.low[parameter] : box.high[parameter];
  const auto bears = [&](double value) {
    Eigen::Vector3d at = box.answer;
    at[parameter] = value;
    return least_squares(model, box, held, at) <= allowed;
  };
  const auto within = [&](double value) {
    return side < 0 ? std::max(bound, value) : std::min(bound, value);
  };
  double reached = box.answer[parameter], missed = reached;
  for (double way = first_guess; way < 1e6; way *= 2) {
    missed = within(box.answer[parameter] + side * way);
    if (!bears(missed)) break;
    reached = missed;
    if (missed == bound) return bound;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (reached + missed);
    (bears(middle) ? reached : missed) = middle;
  }
  return reached;
}

}  // namespace

Eigen::VectorXd QuadraticModel::at(const Eigen::Vector3d& d) const {
  Eigen::VectorXd r = value + slope * d;
  for (int k = 0; k < 6; ++k)
    r += (k < 3 ? 0.5 : 1.0) * d[kPairs[k][0]] * d[kPairs[k][1]] * bend.col(k);
  return r;
}

Eigen::MatrixX3d QuadraticModel::slope_at(const Eigen::Vector3d& d) const {
  Eigen::MatrixX3d j = slope;
  for (int k = 0; k < 6; ++k) {
    const int a = kPairs[k][0], b = kPairs[k][1];
    j.col(a) += d[b] * bend.col(k);
    if (a != b) j.col(b) += d[a] * bend.col(k);
  }
  return j;
}

FitPoint to_fit(const FilmParameters& parameters) {
  return {parameters.z_stretch, 1 / std::sqrt(parameters.stiffness_ratio), parameters.poisson};
}

FilmParameters from_fit(const FitPoint& point) {
  return {point[0], 1 / (point[1] * point[1]), point[2]};
}

FitPoint stencil_center(const FitPoint& point, const FitPoint& widest) {
  const auto nearest = [](double value, double distance) {
    return distance * std::round(value / distance);
  };
  const double power = std::log(std::max(point[1], kLeast[1])) / std::log(kLatticeFactor);
  return {nearest(point[0], widest[0]), std::pow(kLatticeFactor, std::round(power)),
          nearest(point[2], widest[2])};
}

FitPoint stencil_step(const FitPoint& center, const FitPoint& widest) {
  FitPoint step = widest;
  step[1] = std::min(step[1], std::max(kLeastRatioStep, kShareOfRatio * center[1]));
  return step;
}

FilmFit fit_parameters(const FitPoint& start, const MisfitsAt& misfits_at,
                       const FitOptions& options) {
  FilmFit fit;
  for (int k = 0; k < 3; ++k) fit.free[std::size_t(k)] = options.low[k] < options.high[k];
  FitPoint from = start;
  while (true) {
    ++fit.rounds;
    Round round(from, options, fit.free, misfits_at);
    round.solve();
    round.tell(fit, options);
    const FitPoint next = stencil_at(fit.point, options, fit.free).center;
    fit.settled = round.answer().cwiseAbs().maxCoeff() <= kSettled || next == fit.center;
    from = fit.point;
    if (!fit.settled && fit.rounds < options.rounds_max) continue;
    for (FitPoint last = fit.center; options.polished && fit.polishings < kPolishings;) {
      const FitPoint at = round.polishing_point(fit);
      if (at == last) break;
      ++fit.polishings;
      round.put_right(at, misfits_at({at}));
      round.solve();
      round.tell(fit, options);
      last = at;
    }
    return fit;
  }
}

Eigen::VectorXd weights_of(const FilmFit& fit, const std::vector<Eigen::Index>& rows) {
  if (fit.weight.size() == 0) return Eigen::VectorXd::Ones(Eigen::Index(rows.size()));
  return fit.weight(rows);
}

double freedom_of(const Eigen::VectorXd& weights, double fitted) {
  if (weights.size() == 0) return 0;
  return weights.squaredNorm() * (1 - fitted / double(weights.size()));
}

namespace {

// A film is no stiffer without ink, and its Poisson's ratio is a material's.
void set_ends(Certainty& result, const FitPoint& low, const FitPoint& high) {
  const double softest = std::max(high[1], kLeast[1]);
  result.low = {std::max(0.0, low[0]), softest >= 1 ? 1 : 1 / (softest * softest),
                std::max(0.0, low[2])};
  result.high = {
      high[0],
      low[1] > 1.5 * kLeast[1] ? 1 / (low[1] * low[1]) : std::numeric_limits<double>::infinity(),
      std::clamp(high[2], 0.0, 0.499)};
}

}  // namespace

Certainty certainty(const FilmFit& fit, const Eigen::VectorXd& doubt_mm, const FitPoint& astray) {
  std::vector<Eigen::Index> rows, free;
  for (Eigen::Index i = 0; i < fit.residual.size(); ++i)
    if (std::isfinite(fit.residual[i])) rows.push_back(i);
  for (int k = 0; k < 3; ++k)
    if (fit.free[std::size_t(k)]) free.push_back(k);
  const Eigen::VectorXd weight = weights_of(fit, rows);
  const Eigen::MatrixXd j = weight.asDiagonal() * fit.jacobian(rows, free);
  Certainty result;
  const double left = freedom_of(weight, double(fit.open) + double(free.size()));
  const double squares = weight.cwiseProduct(fit.residual(rows)).squaredNorm();
  result.noise_mm = left > 0 ? std::sqrt(squares / left) : 0;
  if (free.empty()) {  // all of them are known
    set_ends(result, fit.point, fit.point);
    return result;
  }

  const Eigen::MatrixXd curvature = j.transpose() * j;
  const MinimumNorm solver(curvature);
  const Eigen::MatrixXd covariance = result.noise_mm * result.noise_mm * solver.pseudo_inverse();
  for (std::size_t a = 0; a < free.size(); ++a)
    for (std::size_t b = 0; b < free.size(); ++b)
      result.covariance(free[a], free[b]) = covariance(Eigen::Index(a), Eigen::Index(b));

  const QuadraticModel& model = fit.model;
  const Box box(fit);
  const double allowed = squares + kQuantile * kQuantile * result.noise_mm * result.noise_mm;
  FitPoint low = fit.point, high = fit.point;
  for (const Eigen::Index k : free) {
    const double guess =
        std::clamp(kQuantile * std::sqrt(result.covariance(k, k)) / fit.step[k], 1e-6, 1e3);
    low[k] = fit.center[k] + fit.step[k] * profile_end(model, box, int(k), -1, guess, allowed);
    high[k] = fit.center[k] + fit.step[k] * profile_end(model, box, int(k), 1, guess, allowed);
  }
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(Eigen::Index(free.size()));
  if (doubt_mm.size() > 0)
    moved = solver.solve(j.transpose() * weight.cwiseProduct(doubt_mm(rows)));
  for (std::size_t a = 0; a < free.size(); ++a) {
    const Eigen::Index k = free[a];
    const double doubt = std::hypot(moved[Eigen::Index(a)], astray[k]);
    low[k] = fit.point[k] - std::hypot(fit.point[k] - low[k], doubt);
    high[k] = fit.point[k] + std::hypot(high[k] - fit.point[k], doubt);
  }
  set_ends(result, low, high);
  return result;
}

double joint_distance(const FilmFit& fit, double noise_mm, int first, double a, int second,
                      double b) {
  Box box(fit);
  Eigen::Vector3d at = box.answer;
  at[first] = (a - fit.center[first]) / fit.step[first];
  at[second] = (b - fit.center[second]) / fit.step[second];
  std::array<bool, 3> held{};
  held[std::size_t(first)] = held[std::size_t(second)] = true;
  const double more =
      least_squares(fit.model, box, held, at) - fit.model.at(box.answer).squaredNorm();
  return noise_mm > 0 ? std::sqrt(std::max(0.0, more)) / noise_mm : 0;
}

}  // namespace hydrodip
