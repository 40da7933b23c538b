#include "calibrate/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "base/error.h"

namespace hydrodip {
namespace {

// What a dip can be computed for, with room for a stencil.
const FitPoint kLeast(0.0, 1e-4, -0.4), kMost(5.0, 1.0, 0.48);
// An answer that moved less than this share of the stencil stays.
constexpr double kSettled = 0.1;
// How far one round may go, in stencils.
constexpr double kTrust = 1.5;
// This near a bound, in stencils, an answer lies at it.
constexpr double kAtBound = 1e-3;
// An answer without bounds only says where noise has driven it.
constexpr int kUnboundedRounds = 4;
// 97.5 % quantile of the normal distribution.
constexpr double kQuantile = 1.96;

// Quadratic in every row: r(d) = r0 + J d + (1/2) sum d_i d_j H_ij, d in stencils.
struct QuadraticModel {
  Eigen::VectorXd value;
  Eigen::MatrixX3d slope;
  Eigen::MatrixXd bend;  // columns: 00, 11, 22, 01, 02, 12

  static constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

  Eigen::VectorXd at(const Eigen::Vector3d& d) const {
    Eigen::VectorXd r = value + slope * d;
    for (int k = 0; k < 6; ++k)
      r += (k < 3 ? 0.5 : 1.0) * d[kPairs[k][0]] * d[kPairs[k][1]] * bend.col(k);
    return r;
  }
  Eigen::MatrixX3d slope_at(const Eigen::Vector3d& d) const {
    Eigen::MatrixX3d j = slope;
    for (int k = 0; k < 6; ++k) {
      const int a = kPairs[k][0], b = kPairs[k][1];
      j.col(a) += d[b] * bend.col(k);
      if (a != b) j.col(b) += d[a] * bend.col(k);
    }
    return j;
  }
};

// The model over the free parameters, for Eigen's optimiser, which knows no bounds: each parameter
// is the sine of one that has none, from its lowest value at -1 to its highest at 1.
struct BoundedModel : Eigen::DenseFunctor<double> {
  BoundedModel(const QuadraticModel& m, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
               const std::vector<int>& f)
      : DenseFunctor(int(f.size()), int(m.value.size())),
        model(m),
        middle(0.5 * (low + high)),
        half(0.5 * (high - low)),
        free(f) {}

  Eigen::Vector3d whole(const Eigen::VectorXd& x) const {
    Eigen::Vector3d d = middle;
    for (std::size_t i = 0; i < free.size(); ++i)
      d[free[i]] += half[free[i]] * std::sin(x[Eigen::Index(i)]);
    return d;
  }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    r = model.at(whole(x));
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& j) const {
    const Eigen::MatrixX3d all = model.slope_at(whole(x));
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto k = Eigen::Index(i);
      j.col(k) = half[free[i]] * std::cos(x[k]) * all.col(free[i]);
    }
    return 0;
  }

  const QuadraticModel& model;
  Eigen::Vector3d middle, half;
  const std::vector<int>& free;
};

// The model's least squares within a box, from where it was made.
Eigen::Vector3d minimize(const QuadraticModel& model, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high) {
  // At a bound itself nothing would move.
  constexpr double kFurthestStart = 0.9;
  std::vector<int> free;
  for (int k = 0; k < 3; ++k)
    if (low[k] < high[k]) free.push_back(k);
  BoundedModel bounded(model, low, high, free);
  if (free.empty() || model.value.size() < Eigen::Index(free.size())) return bounded.middle;
  Eigen::VectorXd x(Eigen::Index(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    x[Eigen::Index(i)] = std::asin(std::clamp(-bounded.middle[free[i]] / bounded.half[free[i]],
                                              -kFurthestStart, kFurthestStart));
  Eigen::LevenbergMarquardt<BoundedModel> optimizer(bounded);
  optimizer.minimize(x);
  Eigen::Vector3d d = bounded.whole(x);
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

std::vector<Eigen::Index> known_rows(const Eigen::MatrixXd& values) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    if (values.row(i).allFinite()) rows.push_back(i);
  return rows;
}

double root_mean_square(const Eigen::VectorXd& values) {
  return values.size() > 0 ? std::sqrt(values.squaredNorm() / double(values.size())) : 0;
}

// The centre of a stencil near a point for which all dips can be computed.
FitPoint inside(const FitPoint& point, const FitPoint& step) {
  return point.cwiseMax(kLeast + step).cwiseMin(kMost - step);
}

// A fit's known lengths and free parameters.
struct KnownFit {
  explicit KnownFit(const Fit& fit) {
    for (Eigen::Index i = 0; i < fit.residual.size(); ++i)
      if (std::isfinite(fit.residual[i])) rows.push_back(i);
    for (int k = 0; k < 3; ++k)
      if (fit.free[std::size_t(k)]) free.push_back(k);
    jacobian = fit.jacobian(rows, free);
  }
  std::vector<Eigen::Index> rows, free;
  Eigen::MatrixXd jacobian;
};

}  // namespace

FitPoint to_fit(const FilmParameters& parameters) {
  return {parameters.z_stretch, 1 / std::sqrt(parameters.stiffness_ratio), parameters.poisson};
}

FilmParameters from_fit(const FitPoint& point) {
  return {point[0], 1 / (point[1] * point[1]), point[2]};
}

FitOptions without_bounds(const FitOptions& options) {
  FitOptions free = options;
  for (int k = 0; k < 3; ++k)
    if (options.low[k] < options.high[k]) free.low[k] = kLeast[k], free.high[k] = kMost[k];
  free.rounds_max = std::min(options.rounds_max, kUnboundedRounds);
  return free;
}

FitPoint stencil_step(const FitPoint& center, const FitPoint& widest) {
  FitPoint step = widest;
  step[1] = std::min(step[1], std::max(0.01, 0.4 * center[1]));
  return step;
}

Fit fit_parameters(const FitPoint& start, const LengthErrors& errors, const FitOptions& options) {
  Fit fit;
  for (int k = 0; k < 3; ++k) fit.free[std::size_t(k)] = options.low[k] < options.high[k];
  FitPoint center = start;
  while (true) {
    ++fit.rounds;
    const FitPoint step = stencil_step(center, options.step);
    Stencil stencil{inside(center, step), step, fit.free};
    for (int k = 0; k < 3; ++k)
      if (!fit.free[std::size_t(k)]) stencil.center[k] = center[k];
    const Eigen::MatrixXd values = errors(stencil.points());
    const std::vector<Eigen::Index> rows = known_rows(values);
    if (rows.size() < 4)
      throw InputError(
          "the scans have too few corners on the film that the simulation lays down; check the "
          "objects' depths");
    const QuadraticModel model = stencil.model(values(rows, Eigen::all));
    const auto in_stencils = [&](const FitPoint& point) -> Eigen::Vector3d {
      return (point - stencil.center).cwiseQuotient(step);
    };
    const Eigen::Vector3d trust = Eigen::Vector3d::Constant(kTrust);
    Eigen::Vector3d low = in_stencils(options.low).cwiseMax(-trust);
    Eigen::Vector3d high = in_stencils(options.high).cwiseMin(trust);
    low = low.cwiseMin(high);
    for (int k = 0; k < 3; ++k)
      if (!fit.free[std::size_t(k)]) low[k] = high[k] = 0;
    const Eigen::Vector3d d = minimize(model, low, high);

    fit.point = stencil.at(d);
    for (int k = 0; k < 3; ++k)
      fit.at_bound[std::size_t(k)] =
          fit.free[std::size_t(k)] &&
          (fit.point[k] <= options.low[k] + 1e-9 || fit.point[k] >= options.high[k] - 1e-9);
    fit.residual =
        Eigen::VectorXd::Constant(values.rows(), std::numeric_limits<double>::quiet_NaN());
    fit.jacobian = Eigen::MatrixX3d::Zero(values.rows(), 3);
    const Eigen::VectorXd residual = model.at(d);
    const Eigen::MatrixX3d slope = model.slope_at(d) * step.cwiseInverse().asDiagonal();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      fit.residual[rows[i]] = residual[Eigen::Index(i)];
      fit.jacobian.row(rows[i]) = slope.row(Eigen::Index(i));
    }
    fit.rms_mm = root_mean_square(residual);
    const double moved = (fit.point - center).cwiseQuotient(step).cwiseAbs().maxCoeff();
    // Inside its stencil, the answer is the model's own.
    fit.settled = moved < kSettled || (fit.rounds > 1 && d.cwiseAbs().maxCoeff() < 0.5);
    if (fit.settled || fit.rounds >= options.rounds_max) return fit;
    center = fit.point;
  }
}

Certainty certainty(const Fit& fit, const Eigen::MatrixXd& noise_gradient,
                    const Eigen::VectorXd& doubt_mm) {
  const KnownFit known(fit);
  const std::vector<Eigen::Index>&rows = known.rows, &free = known.free;
  Certainty result;
  const Eigen::MatrixXd& j = known.jacobian;
  const Eigen::MatrixXd g = noise_gradient(rows, Eigen::all);
  const Eigen::VectorXd residual = fit.residual(rows);

  // Least squares takes d = -(J^T J)^-1 J^T r, and what is left is (I - H) r.
  const Eigen::MatrixXd solve =
      (j.transpose() * j).completeOrthogonalDecomposition().solve(j.transpose());
  const Eigen::MatrixXd left = g - j * (solve * g);
  const double share = left.squaredNorm();
  result.noise_mm = share > 0 ? std::sqrt(residual.squaredNorm() / share) : 0;
  const Eigen::MatrixXd spread = result.noise_mm * (solve * g);
  const Eigen::MatrixXd covariance = spread * spread.transpose();
  for (std::size_t a = 0; a < free.size(); ++a)
    for (std::size_t b = 0; b < free.size(); ++b)
      result.covariance(free[a], free[b]) = covariance(Eigen::Index(a), Eigen::Index(b));

  Eigen::Vector3d half = kQuantile * result.covariance.diagonal().cwiseSqrt();
  if (doubt_mm.size() > 0) {
    const Eigen::VectorXd moved = solve * doubt_mm(rows);
    for (std::size_t a = 0; a < free.size(); ++a)
      half[free[a]] = std::hypot(half[free[a]], moved[Eigen::Index(a)]);
  }
  const FitPoint low = fit.point - half, high = fit.point + half;
  // A film is no stiffer without ink, and its Poisson's ratio is a material's.
  const double softest = std::max(high[1], kLeast[1]);
  result.low = {std::max(0.0, low[0]), softest >= 1 ? 1 : 1 / (softest * softest),
                std::max(0.0, low[2])};
  result.high = {high[0],
                 low[1] > 0 ? 1 / (low[1] * low[1]) : std::numeric_limits<double>::infinity(),
                 std::clamp(high[2], 0.0, 0.499)};
  return result;
}

// The sum of squares to be expected is that without noise and noise_mm^2 times that of the noise
// gradient. Where the first one's slope is 0, the second one's is not.
FitPoint noise_bias(const Fit& fit, double noise_mm, const NoiseGradient& gradient,
                    const FitPoint& step) {
  const KnownFit known(fit);
  const auto count = Eigen::Index(known.free.size());
  const FitPoint center = inside(fit.point, step);
  // Per length, on both sides of the answer.
  Eigen::MatrixXd before(Eigen::Index(known.rows.size()), count), after = before;
  for (Eigen::Index k = 0; k < count; ++k) {
    const FitPoint way =
        step[known.free[std::size_t(k)]] * Eigen::Vector3d::Unit(known.free[std::size_t(k)]);
    before.col(k) = gradient(center - way)(known.rows, Eigen::all).rowwise().squaredNorm();
    after.col(k) = gradient(center + way)(known.rows, Eigen::all).rowwise().squaredNorm();
  }
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < before.rows(); ++i)
    if (before.row(i).minCoeff() > 0 && after.row(i).minCoeff() > 0)
      slope += (after.row(i) - before.row(i)).transpose();
  for (Eigen::Index k = 0; k < count; ++k) slope[k] /= 2 * step[known.free[std::size_t(k)]];

  const Eigen::MatrixXd curvature = known.jacobian.transpose() * known.jacobian;
  const Eigen::VectorXd moved =
      curvature.completeOrthogonalDecomposition().solve(-0.5 * noise_mm * noise_mm * slope);
  FitPoint bias = FitPoint::Zero();
  bias(known.free) = moved;
  return bias;
}

}  // namespace hydrodip
