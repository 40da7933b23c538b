#include "calibrate/fit.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "base/dense_solvers.h"

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

// Misfits of a scan whose rows carry some fixed noise.
MisfitsAt scan_with(const FitPoint& truth, const Eigen::VectorXd& noise, int* calls = nullptr,
                    const Eigen::MatrixXd& open = Eigen::MatrixXd(kLengths, 0)) {
  return [=](const std::vector<FitPoint>& points) {
    if (calls) *calls += int(points.size());
    Eigen::MatrixXd errors(kLengths, Eigen::Index(points.size()));
    for (std::size_t p = 0; p < points.size(); ++p)
      errors.col(Eigen::Index(p)) = lengths_at(points[p], truth) + noise;
    return Misfits{errors, open};
  };
}

TEST(FitTest, FindsTheTruthFromAfar) {
  const FitPoint truth(0.65, 0.18, 0.1);
  int calls = 0;
  const FilmFit fit = fit_parameters(
      {0.8, 0.3, 0.3}, scan_with(truth, Eigen::VectorXd::Zero(kLengths), &calls), wide());
  EXPECT_TRUE(fit.settled);
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_LE(calls, 10 * fit.rounds);
}

// A correction that is found at the first point alone, as on finer film, and that is another one
// elsewhere: the answer is what it would be if it were known everywhere.
TEST(FitTest, APolishedAnswerIsCorrectedAtItsOwnPlace) {
  const FitPoint truth(0.662, 0.19, 0.13);
  const Eigen::MatrixXd turn = 0.4 * Eigen::MatrixXd::Random(kLengths, 3);
  const MisfitsAt misfits = [&](const std::vector<FitPoint>& points) {
    Misfits found = scan_with(truth, Eigen::VectorXd::Zero(kLengths))(points);
    found.value.colwise() += turn * (points.front() - truth);
    return found;
  };
  FitOptions options = wide();
  const double rough = (fit_parameters({0.6, 0.2, 0.2}, misfits, options).point - truth).norm();
  options.polished = true;
  const FilmFit fit = fit_parameters({0.6, 0.2, 0.2}, misfits, options);
  EXPECT_GT(rough, 1e-3);
  EXPECT_LT((fit.point - truth).norm(), 0.35 * rough);
}

TEST(FitTest, StaysWithinTheRangeAndSaysSo) {
  const FitPoint truth(0.65, 0.18, -0.05);
  const FilmFit fit =
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
  const FilmFit fit = fit_parameters(
      {0.75, 0.25, 0.1}, scan_with(truth, Eigen::VectorXd::Zero(kLengths), &calls), options);
  EXPECT_DOUBLE_EQ(fit.point[2], 0.1);
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_EQ(calls, 6 * fit.rounds);
}

TEST(FitTest, UnknownLengthsAreLeftOut) {
  const FitPoint truth(0.65, 0.18, 0.1);
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(kLengths);
  for (int i = 0; i < kLengths; i += 3) noise[i] = std::nan("");
  const FilmFit fit = fit_parameters({0.6, 0.2, 0.2}, scan_with(truth, noise), wide());
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_TRUE(std::isnan(fit.residual[0]));
}

// Rows that the simulation gets wrong by as much as it says do not lead astray, and what is left of
// them is told in millimetres all the same.
TEST(FitTest, WhatTheSimulationDoesNotKnowWeighsLess) {
  const FitPoint truth(0.65, 0.18, 0.1);
  Eigen::VectorXd wrong = Eigen::VectorXd::Zero(kLengths), uncertain = wrong;
  for (int i = 0; i < kLengths; i += 4) wrong[i] = 0.06, uncertain[i] = 10;
  const Eigen::MatrixXd open = Eigen::MatrixXd::Random(kLengths, 3);
  const MisfitsAt plain = scan_with(truth, wrong, nullptr, open);
  const auto weighed = [&](const std::vector<FitPoint>& points) {
    Misfits found = plain(points);
    found.uncertain_mm = uncertain;
    return found;
  };
  const double astray = (fit_parameters({0.6, 0.2, 0.2}, plain, wide()).point - truth).norm();
  const FilmFit fit = fit_parameters({0.6, 0.2, 0.2}, weighed, wide());
  EXPECT_GT(astray, 0.01);
  EXPECT_LT((fit.point - truth).norm(), 2e-3);
  EXPECT_LT(fit.weight[0], 0.01);
  EXPECT_EQ(fit.weight[1], 1);
  for (int i = 0; i < kLengths; i += 4) EXPECT_NEAR(fit.residual[i], 0.06, 0.005) << i;
}

// However much of what nobody has measured is in a scan, the answer and its noise stay.
TEST(FitTest, OpenMotionsDoNotMatter) {
  const FitPoint truth(0.65, 0.18, 0.1);
  const Eigen::MatrixXd open = Eigen::MatrixXd::Random(kLengths, 4);
  const Eigen::VectorXd noise = 1e-3 * Eigen::VectorXd::Random(kLengths);
  const FilmFit still =
      fit_parameters({0.6, 0.2, 0.2}, scan_with(truth, noise, nullptr, open), wide());
  const FilmFit moved = fit_parameters(
      {0.6, 0.2, 0.2},
      scan_with(truth, noise + open * Eigen::Vector4d(1, -2, 0.5, 3), nullptr, open), wide());
  EXPECT_LT((still.point - moved.point).norm(), 1e-6);
  EXPECT_NEAR(certainty(still).noise_mm, certainty(moved).noise_mm, 1e-7);
  EXPECT_EQ(still.open, 4u);
}

// Answers near each other are read off the same simulations.
TEST(FitTest, StencilsLieOnALattice) {
  const FitPoint widest = wide().step;
  const FitPoint node = stencil_center({0.65, 0.04, 0.1}, widest);
  EXPECT_EQ(node, stencil_center({0.651, 0.0405, 0.102}, widest));
  EXPECT_EQ(node, stencil_center(node, widest));
  // Wherever the answer is, a node is no further than its stencil reaches.
  for (double ratio = 1.2; ratio < 5000; ratio *= 1.1) {
    const FitPoint point = to_fit({0.617, ratio, 0.233});
    const FitPoint center = stencil_center(point, widest);
    const FitPoint off = (point - center).cwiseQuotient(stencil_step(center, widest));
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1.5) << ratio;
  }
}

void count_covered(const Certainty& found, const FitPoint& truth, std::array<int, 3>& covered) {
  const FilmParameters t = from_fit(truth);
  covered[0] += found.low.z_stretch <= t.z_stretch && t.z_stretch <= found.high.z_stretch;
  covered[1] += found.low.stiffness_ratio <= t.stiffness_ratio &&
                t.stiffness_ratio <= found.high.stiffness_ratio;
  covered[2] += found.low.poisson <= t.poisson && t.poisson <= found.high.poisson;
}

// 95 % intervals hold the truth 95 times in 100; binomial, 4 standard deviations of leeway.
TEST(CertaintyTest, IntervalsCoverTheTruthAsOftenAsTheySay) {
  const FitPoint truth(0.65, 0.25, 0.2);
  constexpr int kSeeds = 400;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  const Eigen::MatrixXd open = Eigen::MatrixXd::Random(kLengths, 10);
  std::array<int, 3> covered{};
  double noise_mm = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Eigen::VectorXd noise(kLengths);
    for (double& n : noise) n = 0.01 * normal(random);
    const FilmFit fit = fit_parameters(truth, scan_with(truth, noise, nullptr, open), wide());
    const Certainty found = certainty(fit);
    noise_mm += found.noise_mm / kSeeds;
    count_covered(found, truth, covered);
  }
  EXPECT_NEAR(noise_mm, 0.01, 0.0005);
  const double leeway = 4 * std::sqrt(0.95 * 0.05 * kSeeds);
  for (const int count : covered) EXPECT_NEAR(count, 0.95 * kSeeds, leeway);
}

// Simulations that are off by as much as they say, each row by itself, leave the intervals right:
// they hold the truth at least as often as they say, and the noise is the scan's or more.
TEST(CertaintyTest, IntervalsCoverTheTruthWhereSimulationsAreUncertain) {
  const FitPoint truth(0.65, 0.25, 0.2);
  constexpr int kSeeds = 200;
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 1);
  Eigen::VectorXd uncertain = Eigen::VectorXd::Zero(kLengths);
  for (int i = 0; i < kLengths; i += 2) uncertain[i] = 0.03;
  std::array<int, 3> covered{};
  for (int seed = 0; seed < kSeeds; ++seed) {
    Eigen::VectorXd off(kLengths);
    for (int i = 0; i < kLengths; ++i) off[i] = std::hypot(0.01, uncertain[i]) * normal(random);
    const auto misfits = [&](const std::vector<FitPoint>& points) {
      Misfits found = scan_with(truth, off)(points);
      found.uncertain_mm = uncertain;
      return found;
    };
    const Certainty found = certainty(fit_parameters(truth, misfits, wide()));
    EXPECT_GT(found.noise_mm, 0.008);
    count_covered(found, truth, covered);
  }
  const double leeway = 4 * std::sqrt(0.95 * 0.05 * kSeeds);
  for (const int count : covered) EXPECT_GT(count, 0.95 * kSeeds - leeway);
}

// A fit whose rows are straight in the parameters.
FilmFit straight_fit(const FitPoint& answer, const Eigen::MatrixX3d& jacobian,
                     const Eigen::VectorXd& residual) {
  FitOptions options = wide();
  options.low = FitPoint(0, 1e-4, 0);
  options.high = FitPoint(5, 1, 0.48);
  return fit_parameters(
      answer,
      [&](const std::vector<FitPoint>& points) {
        Eigen::MatrixXd values(jacobian.rows(), Eigen::Index(points.size()));
        for (std::size_t p = 0; p < points.size(); ++p)
          values.col(Eigen::Index(p)) = residual + jacobian * (points[p] - answer);
        return Misfits{values, Eigen::MatrixXd(jacobian.rows(), 0)};
      },
      options);
}

// Residuals at right angles to all that the parameters do, so that the answer is as it is.
Eigen::VectorXd unexplained(const Eigen::MatrixX3d& jacobian, double size) {
  const Eigen::VectorXd random = Eigen::VectorXd::Random(jacobian.rows());
  const Eigen::VectorXd left = random - jacobian * MinimumNorm(jacobian).solve(random);
  return size * left / left.norm() * std::sqrt(double(left.size()));
}

TEST(CertaintyTest, ARatioThatNothingBoundsIsUnbounded) {
  Eigen::MatrixX3d jacobian = Eigen::MatrixX3d::Random(30, 3);
  jacobian.col(1) *= 0.1;
  const Certainty found =
      certainty(straight_fit({0.65, 0.05, 0.1}, jacobian, unexplained(jacobian, 0.05)));
  EXPECT_TRUE(std::isinf(found.high.stiffness_ratio));
  EXPECT_GE(found.low.stiffness_ratio, 1);
}

// Where rows are straight, the profile of the likelihood is the curvature's parabola.
TEST(CertaintyTest, ProfileAndCurvatureAgreeWhereAllIsStraight) {
  const Eigen::MatrixX3d jacobian = Eigen::MatrixX3d::Random(200, 3);
  const FitPoint answer(0.65, 0.3, 0.2);
  const FilmFit fit = straight_fit(answer, jacobian, unexplained(jacobian, 0.05));
  const Certainty found = certainty(fit);
  const FitPoint half = 1.96 * found.covariance.diagonal().cwiseSqrt();
  EXPECT_LT((fit.point - answer).norm(), 1e-6);
  EXPECT_NEAR(found.low.z_stretch, answer[0] - half[0], 1e-3 * half[0]);
  EXPECT_NEAR(found.high.z_stretch, answer[0] + half[0], 1e-3 * half[0]);
  EXPECT_NEAR(1 / std::sqrt(found.low.stiffness_ratio), answer[1] + half[1], 1e-3 * half[1]);
  EXPECT_NEAR(found.high.poisson, answer[2] + half[2], 1e-3 * half[2]);
  // And two parameters' joint distance is that of their covariance.
  const Eigen::Vector2d way(0.004, -0.003);
  Eigen::Matrix2d both;
  both << found.covariance(0, 0), found.covariance(0, 2), found.covariance(2, 0),
      found.covariance(2, 2);
  EXPECT_NEAR(joint_distance(fit, found.noise_mm, 0, answer[0] + way[0], 2, answer[2] + way[1]),
              std::sqrt(way.dot(both.inverse() * way)), 1e-3);
}

// Rows that are wrong just as another parameter would make them move the answer by that much.
TEST(CertaintyTest, DoubtsWidenTheIntervalsByWhatTheyDoToTheAnswer) {
  const Eigen::MatrixX3d jacobian = Eigen::MatrixX3d::Random(40, 3);
  const FilmFit fit = straight_fit({0.6, 0.2, 0.2}, jacobian, Eigen::VectorXd::Zero(40));
  const Certainty sure = certainty(fit, jacobian * Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_NEAR(sure.low.z_stretch, 0.59, 1e-6);
  EXPECT_NEAR(sure.high.z_stretch, 0.61, 1e-6);
  EXPECT_NEAR(sure.low.stiffness_ratio, 1 / (0.22 * 0.22), 1e-3);
  EXPECT_NEAR(sure.high.stiffness_ratio, 1 / (0.18 * 0.18), 1e-3);
  EXPECT_NEAR(sure.low.poisson, 0.17, 1e-6);
  EXPECT_NEAR(sure.high.poisson, 0.23, 1e-6);
}

// As do errors that no row tells of; independent ones add by their squares.
TEST(CertaintyTest, WhatIsKnownToLeadAstrayWidensTheIntervals) {
  const Eigen::MatrixX3d jacobian = Eigen::MatrixX3d::Random(40, 3);
  const FilmFit fit = straight_fit({0.6, 0.2, 0.2}, jacobian, Eigen::VectorXd::Zero(40));
  const Certainty alone = certainty(fit, {}, {0.004, 0.02, 0.04});
  EXPECT_NEAR(alone.low.z_stretch, 0.596, 1e-6);
  EXPECT_NEAR(alone.high.stiffness_ratio, 1 / (0.18 * 0.18), 1e-3);
  EXPECT_NEAR(alone.high.poisson, 0.24, 1e-6);
  const Certainty both =
      certainty(fit, jacobian * Eigen::Vector3d(0.003, 0, 0.03), {0.004, 0.02, 0.04});
  EXPECT_NEAR(both.low.z_stretch, 0.595, 1e-6);
  EXPECT_NEAR(both.high.poisson, 0.25, 1e-6);
}

// A quadratic's difference over any distance, however long, is its slope in the middle.
TEST(QuadraticModelTest, SlopeIsThatOfItsValues) {
  QuadraticModel model;
  model.value = Eigen::VectorXd::Random(7);
  model.slope = Eigen::MatrixX3d::Random(7, 3);
  model.bend = Eigen::MatrixXd::Random(7, 6);
  for (int n = 0; n < 20; ++n) {
    const Eigen::Vector3d middle = Eigen::Vector3d::Random(), half = Eigen::Vector3d::Random();
    const Eigen::VectorXd difference = model.at(middle + half) - model.at(middle - half);
    EXPECT_LT((difference - 2 * model.slope_at(middle) * half).norm(), 1e-12);
  }
}

// An answer a hair inside of a bound is the bound: nobody can tell them apart.
TEST(FitTest, AnAnswerAHairFromABoundLiesAtIt) {
  const Eigen::MatrixX3d jacobian = Eigen::MatrixX3d::Random(40, 3);
  const Eigen::VectorXd exact = Eigen::VectorXd::Zero(40);
  const double stencil = wide().step[2];
  for (const double bound : {0.0, 0.48}) {
    const double inward = bound > 0 ? -stencil : stencil;
    const FilmFit at = straight_fit({0.65, 0.3, bound + 5e-4 * inward}, jacobian, exact);
    EXPECT_NEAR(at.point[2], bound, 1e-12);
    EXPECT_TRUE(at.at_bound[2]);
    const FilmFit off = straight_fit({0.65, 0.3, bound + 5e-3 * inward}, jacobian, exact);
    EXPECT_NEAR(off.point[2], bound + 5e-3 * inward, 1e-7);
    EXPECT_FALSE(off.at_bound[2]);
  }
}

TEST(FitPointTest, ComesBack) {
  const FilmParameters p = from_fit(to_fit({0.65, 600, 0.2}));
  EXPECT_NEAR(p.stiffness_ratio, 600, 1e-9);
  EXPECT_DOUBLE_EQ(p.z_stretch, 0.65);
  EXPECT_DOUBLE_EQ(p.poisson, 0.2);
}

}  // namespace
}  // namespace hydrodip
