#include "register/displacement_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/dense_solvers.h"
#include "base/error.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr std::size_t kLeastSamples = 12, kMostPlaces = 450;
constexpr double kLengths_mm[] = {12, 18, 27, 40, 60, 90, 140};
// Variance of a sample's noise over that of the field.
constexpr double kNoiseShares[] = {1e-4, 1e-3, 1e-2, 0.1, 1, 10};
constexpr double kPitch_mm = 5, kBeyond_mm = 10;
constexpr int kDrift = 3;  // 1, x, y

// Of the samples that lie near to each other.
struct Place {
  Vec2 at = Vec2::Zero(), move = Vec2::Zero();
  double count = 0;
  double scatter = 0;  // sum of the samples' squares about their mean
};

std::vector<Place> averaged(const std::vector<CorrectionSample>& samples, double pitch_mm) {
  std::map<std::pair<long, long>, Place> cells;
  for (const CorrectionSample& s : samples) {
    Place& cell =
        cells[{std::lround(s.model_mm.x() / pitch_mm), std::lround(s.model_mm.y() / pitch_mm)}];
    cell.at += s.model_mm;
    cell.move += s.move_mm;
    cell.scatter += s.move_mm.squaredNorm();
    ++cell.count;
  }
  std::vector<Place> places;
  places.reserve(cells.size());
  for (auto& [key, cell] : cells)
    places.push_back({cell.at / cell.count, cell.move / cell.count, cell.count,
                      std::max(0.0, cell.scatter - cell.move.squaredNorm() / cell.count)});
  return places;
}

std::vector<Place> few_enough(const std::vector<CorrectionSample>& samples) {
  double pitch_mm = 0.5;
  std::vector<Place> places = averaged(samples, pitch_mm);
  while (places.size() > kMostPlaces) places = averaged(samples, pitch_mm *= 1.3);
  return places;
}

double covariance(const Vec2& from, double length_mm) {
  return std::exp(-0.5 * from.squaredNorm() / (length_mm * length_mm));
}

// Coordinates of the drift are scaled, so that the system is even.
Vec3 drift(const Vec2& at) { return {1, at.x() / 100, at.y() / 100}; }

// The inverse of the kriging system, by which everything is foretold.
struct Kriging {
  double length_mm = 0, noise_share = 0;
  Eigen::MatrixXd inverse;   // of samples, then drift
  Eigen::MatrixX2d weights;  // for the samples' displacements
  double left_out = 0;       // mean square of both components together, of places' means
  double variance = 0;       // of the field
};

Kriging krige(const std::vector<Place>& places, double length_mm, double noise_share) {
  check_cancelled();
  const auto n = Eigen::Index(places.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + kDrift, n + kDrift);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n + kDrift, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Place& p = places[std::size_t(i)];
    for (Eigen::Index j = 0; j < i; ++j)
      system(i, j) = system(j, i) = covariance(p.at - places[std::size_t(j)].at, length_mm);
    system(i, i) = 1 + noise_share / p.count;
    system.block<1, kDrift>(i, n) = drift(p.at);
    system.block<kDrift, 1>(n, i) = drift(p.at);
    right.row(i) = p.move;
  }
  Kriging result{length_mm, noise_share, inverse_of(system), {}, 0, 0};
  result.weights = result.inverse * right;
  double count = 0, square = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec2 off = result.weights.row(i) / result.inverse(i, i);
    square += places[std::size_t(i)].count * off.squaredNorm();
    count += places[std::size_t(i)].count;
  }
  result.left_out = square / count;
  result.variance = (right.array() * result.weights.array()).sum() / double(2 * (n - kDrift));
  return result;
}

Kriging best_of(const std::vector<Place>& places) {
  Kriging best;
  best.left_out = std::numeric_limits<double>::infinity();
  for (const double length : kLengths_mm)
    for (const double share : kNoiseShares) {
      Kriging tried = krige(places, length, share);
      if (std::isfinite(tried.left_out) && tried.variance > 0 && tried.left_out < best.left_out)
        best = std::move(tried);
    }
  // Displacements that are affine to the last digit.
  if (best.inverse.size() == 0) best = krige(places, kLengths_mm[6], 1);
  return best;
}

// A sample is off by as much as its place's mean, and by as much as it is off that.
double scatter_of_samples(const std::vector<Place>& places) {
  double scatter = 0, count = 0;
  for (const Place& p : places) {
    scatter += p.scatter;
    count += p.count;
  }
  return scatter / count;
}

void require_spread(const std::vector<Place>& places) {
  Vec2 mean = Vec2::Zero();
  for (const Place& p : places) mean += p.at / double(places.size());
  Mat2 spread = Mat2::Zero();
  for (const Place& p : places)
    spread += (p.at - mean) * (p.at - mean).transpose() / double(places.size());
  if (places.size() < kLeastSamples)
    throw InputError(fmt::format(
        "the scans show {} of the film that can be used: at least {} are needed",
        places.size() == 1 ? "one place" : fmt::format("{} places", places.size()), kLeastSamples));
  if (!(spread.determinant() > 1))
    throw InputError(fmt::format(
        "the {} places of the film that can be used lie along one line, or all within some "
        "millimetres: they have to be spread over the film; check that they are in mm",
        places.size()));
}

}  // namespace

DisplacementFit fit_displacements(const std::vector<CorrectionSample>& samples,
                                  const FitArea& area) {
  const std::vector<Place> places = few_enough(samples);
  require_spread(places);
  const Kriging kriging = best_of(places);
  const auto n = Eigen::Index(places.size());

  DisplacementFit fit;
  FilmCorrection& field = fit.field;
  field.pitch_mm = kPitch_mm;
  field.first = area.min - Vec2::Constant(kBeyond_mm);
  const Vec2 cells = (area.max - area.min + Vec2::Constant(2 * kBeyond_mm)) / kPitch_mm;
  field.nx = int(std::ceil(cells.x())) + 1;
  field.ny = int(std::ceil(cells.y())) + 1;
  Eigen::VectorXd to(n + kDrift);
  for (int j = 0; j < field.ny; ++j)
    for (int i = 0; i < field.nx; ++i) {
      check_cancelled();
      const Vec2 at = field.first + kPitch_mm * Vec2(i, j);
      for (Eigen::Index k = 0; k < n; ++k)
        to[k] = covariance(at - places[std::size_t(k)].at, kriging.length_mm);
      to.tail<kDrift>() = drift(at);
      field.move.emplace_back(kriging.weights.transpose() * to);
      fit.sigma_mm.push_back(
          std::sqrt(std::max(0.0, kriging.variance * (1 - to.dot(kriging.inverse * to)))));
    }
  fit.smooth_mm = kriging.length_mm;
  fit.noise_mm = std::sqrt(std::max(0.0, kriging.variance * kriging.noise_share));
  fit.left_out_rms_mm = std::sqrt(kriging.left_out + scatter_of_samples(places));
  return fit;
}

}  // namespace hydrodip
