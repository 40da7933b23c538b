#include "calibrate/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hydrodip {
namespace {

constexpr int kLengths = 120;

// Lengths that bend with the parameters, the more so the further away; exactly 0 at the truth.
Eigen::VectorXd lengths_at(const FitPoint& point, const FitPoint& truth) {
  Eigen::VectorXd errors(kLengths);
  const FitPoint d = point - truth;
  for (int i = 0; i < kLengths; ++i) {
    const double a = std::sin(1.0 + i), b = std::cos(2.0 * i), c = std::sin(0.7 * i * i);
    errors[i] = a * d[0] + 0.4 * b * d[1] + 0.3 * c * d[2] + 0.5 * c * std::sin(d[0] * d[0]) +
                0.2 * a * d[1] * d[2];
  }
  return errors;
}

FitOptions wide() {
  FitOptions options;
  options.low = FitPoint(0.2, 0.02, 0);
  options.high = FitPoint(1.2, 0.6, 0.45);
  options.step = FitPoint(0.03, 0.1, 0.06);
  return options;
}

// Errors of a scan whose lengths carry some fixed noise.
LengthErrors scan_with(const FitPoint& truth, const Eigen::VectorXd& noise, int* calls = nullptr) {
  return [=](const std::vector<FitPoint>& points) {
    if (calls) *calls += int(points.size());
    Eigen::MatrixXd errors(kLengths, Eigen::Index(points.size()));
    for (std::size_t p = 0; p < points.size(); ++p)
      errors.col(Eigen::Index(p)) = lengths_at(points[p], truth) + noise;
    return errors;
  };
}

TEST(FitTest, FindsTheTruthFromAfar) {
  const FitPoint truth(0.65, 0.18, 0.1);
  int calls = 0;
  const Fit fit = fit_parameters({0.8, 0.3, 0.3},
                                 scan_with(truth, Eigen::VectorXd::Zero(kLengths), &calls), wide());
  EXPECT_TRUE(fit.settled);
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_LE(calls, 10 * fit.rounds);
}

TEST(FitTest, StaysWithinTheRangeAndSaysSo) {
  const FitPoint truth(0.65, 0.18, -0.05);
  const Fit fit =
      fit_parameters({0.6, 0.2, 0.1}, scan_with(truth, Eigen::VectorXd::Zero(kLengths)), wide());
  EXPECT_GE(fit.point[2], 0);
  EXPECT_NEAR(fit.point[2], 0, 1e-12);
  EXPECT_TRUE(fit.at_bound[2]);
  EXPECT_FALSE(fit.at_bound[0]);
}

TEST(FitTest, AKnownParameterStaysAndCostsNothing) {
  const FitPoint truth(0.65, 0.18, 0.1);
  FitOptions options = wide();
  options.low[2] = options.high[2] = 0.1;
  int calls = 0;
  const Fit fit = fit_parameters(
      {0.75, 0.25, 0.1}, scan_with(truth, Eigen::VectorXd::Zero(kLengths), &calls), options);
  EXPECT_DOUBLE_EQ(fit.point[2], 0.1);
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_EQ(calls, 6 * fit.rounds);
}

TEST(FitTest, UnknownLengthsAreLeftOut) {
  const FitPoint truth(0.65, 0.18, 0.1);
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(kLengths);
  for (int i = 0; i < kLengths; i += 3) noise[i] = std::nan("");
  const Fit fit = fit_parameters({0.6, 0.2, 0.2}, scan_with(truth, noise), wide());
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_TRUE(std::isnan(fit.residual[0]));
}

// 95 % intervals hold the truth 95 times in 100; binomial, 4 standard deviations of leeway.
TEST(CertaintyTest, IntervalsCoverTheTruthAsOftenAsTheySay) {
  const FitPoint truth(0.65, 0.25, 0.2);
  constexpr int kSeeds = 400;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  // Each length sees two of the noise's coordinates, as edges do.
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(kLengths, kLengths / 2 + 1);
  for (int i = 0; i < kLengths; ++i) {
    gradient(i, i / 2) = 1;
    gradient(i, i / 2 + 1) = -0.6;
  }
  std::array<int, 3> covered{};
  double noise_mm = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Eigen::VectorXd corners(gradient.cols());
    for (double& c : corners) c = 0.01 * normal(random);
    const Fit fit = fit_parameters(truth, scan_with(truth, gradient * corners), wide());
    const Certainty found = certainty(fit, gradient);
    noise_mm += found.noise_mm / kSeeds;
    const FilmParameters t = from_fit(truth);
    covered[0] += found.low.z_stretch <= t.z_stretch && t.z_stretch <= found.high.z_stretch;
    covered[1] += found.low.stiffness_ratio <= t.stiffness_ratio &&
                  t.stiffness_ratio <= found.high.stiffness_ratio;
    covered[2] += found.low.poisson <= t.poisson && t.poisson <= found.high.poisson;
  }
  EXPECT_NEAR(noise_mm, 0.01, 0.0005);
  const double leeway = 4 * std::sqrt(0.95 * 0.05 * kSeeds);
  for (const int count : covered) EXPECT_NEAR(count, 0.95 * kSeeds, leeway);
}

TEST(CertaintyTest, ARatioThatNothingBoundsIsUnbounded) {
  Fit fit;
  fit.point = FitPoint(0.65, 0.05, 0.1);
  fit.free = {true, true, true};
  fit.residual = Eigen::VectorXd::Constant(30, 0.05);
  fit.jacobian = Eigen::MatrixX3d::Random(30, 3);
  fit.jacobian.col(1) *= 0.1;
  const Certainty found = certainty(fit, Eigen::MatrixXd::Identity(30, 30));
  EXPECT_TRUE(std::isinf(found.high.stiffness_ratio));
  EXPECT_GE(found.low.stiffness_ratio, 1);
}

// Lengths that are wrong just as another parameter would make them move the answer by that much.
TEST(CertaintyTest, DoubtsWidenTheIntervalsByWhatTheyDoToTheAnswer) {
  Fit fit;
  fit.point = FitPoint(0.6, 0.2, 0.2);
  fit.free = {true, true, true};
  fit.jacobian = Eigen::MatrixX3d::Random(40, 3);
  fit.residual = Eigen::VectorXd::Zero(40);
  const Eigen::Vector3d moved(0.01, 0.02, 0.03);
  const Certainty sure = certainty(fit, Eigen::MatrixXd::Identity(40, 40), fit.jacobian * moved);
  EXPECT_NEAR(sure.low.z_stretch, 0.59, 1e-9);
  EXPECT_NEAR(sure.high.z_stretch, 0.61, 1e-9);
  EXPECT_NEAR(sure.low.stiffness_ratio, 1 / (0.22 * 0.22), 1e-6);
  EXPECT_NEAR(sure.high.stiffness_ratio, 1 / (0.18 * 0.18), 1e-6);
  EXPECT_NEAR(sure.low.poisson, 0.17, 1e-9);
  EXPECT_NEAR(sure.high.poisson, 0.23, 1e-9);
}

// Lengths that show noise the less, the larger the first parameter is: least squares answers too
// high on average, by what is predicted (to first order; the rest is what remains of 400 seeds).
TEST(NoiseBiasTest, IsHowFarNoiseMovesTheAnswerOnAverage) {
  const FitPoint truth(0.65, 0.25, 0.2);
  constexpr int kSeeds = 400;
  constexpr double kNoise = 0.03;
  const auto shown = [](const FitPoint& point) { return 1 - 0.8 * point[0]; };
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  FitPoint mean = FitPoint::Zero(), predicted = FitPoint::Zero();
  Eigen::VectorXd noise(kLengths);
  const Eigen::MatrixXd independent = Eigen::MatrixXd::Identity(kLengths, kLengths);
  const LengthErrors errors = [&](const std::vector<FitPoint>& points) {
    Eigen::MatrixXd list(kLengths, Eigen::Index(points.size()));
    for (std::size_t p = 0; p < points.size(); ++p)
      list.col(Eigen::Index(p)) = lengths_at(points[p], truth) + shown(points[p]) * noise;
    return list;
  };
  const NoiseGradient gradient = [&](const FitPoint& point) {
    return Eigen::MatrixXd(shown(point) * independent);
  };
  for (int seed = 0; seed < kSeeds; ++seed) {
    for (double& n : noise) n = kNoise * normal(random);
    const Fit fit = fit_parameters(truth, errors, wide());
    mean += (fit.point - truth) / kSeeds;
    predicted += noise_bias(fit, kNoise, gradient, wide().step) / kSeeds;
  }
  EXPECT_GT(predicted[0], 3e-4);
  EXPECT_NEAR(mean[0], predicted[0], 0.4 * predicted[0]);
}

TEST(FitPointTest, ComesBack) {
  const FilmParameters p = from_fit(to_fit({0.65, 600, 0.2}));
  EXPECT_NEAR(p.stiffness_ratio, 600, 1e-9);
  EXPECT_DOUBLE_EQ(p.z_stretch, 0.65);
  EXPECT_DOUBLE_EQ(p.poisson, 0.2);
}

}  // namespace
}  // namespace hydrodip
