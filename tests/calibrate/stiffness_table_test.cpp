#include "calibrate/stiffness_table.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "base/dense_solvers.h"

namespace hydrodip {
namespace {

constexpr int kRows = 300;
const std::vector<double> kDensities = {0.01, 0.1, 1};
const FitPoint kAnswer = to_fit({0.65, 100, 0.1});

// A fit of rows that move straight with z_stretch, nu and each ink's stiffness, in which inks are
// stiffer than the law by `more` (logarithms).
struct Scan {
  Scan(const Eigen::Vector3d& more, std::uint32_t seed, bool ratio_is_given = false) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto noise = [&] { return normal(random); };
    by_ink = Eigen::MatrixXd::NullaryExpr(kRows, 3, noise);
    fit.point = fit.center = kAnswer;
    fit.free = {true, true, true};
    fit.jacobian = Eigen::MatrixXd::NullaryExpr(kRows, 3, noise);
    // What the law can do to the ratio, it has done.
    fit.jacobian.col(1) = by_ink * law_slope();
    Eigen::VectorXd residual = -by_ink * more + 0.05 * Eigen::VectorXd::NullaryExpr(kRows, noise);
    fit.free[1] = !ratio_is_given;
    const Eigen::MatrixXd done = fit.jacobian(
        Eigen::all, ratio_is_given ? std::vector<int>{0, 2} : std::vector<int>{0, 1, 2});
    residual -= done * MinimumNorm(done).solve(residual);
    fit.residual = residual;
  }
  // How inks' logarithms change with the ratio by the law.
  static Eigen::Vector3d law_slope() {
    Eigen::Vector3d slope;
    for (int i = 0; i < 3; ++i)
      slope[i] = kDensities[std::size_t(i)] / (1 + kDensities[std::size_t(i)] * 99);
    return slope;
  }
  FilmFit fit;
  Eigen::MatrixXd by_ink;
};

TEST(StiffnessTableTest, InkThatFollowsTheLawIsFoundToDoSo) {
  int holds = 0, inside = 0;
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scan scan({0, 0, 0}, std::uint32_t(seed));
    const StiffnessTable table = stiffness_table(scan.fit, kDensities, scan.by_ink);
    holds += table.law_holds;
    inside +=
        table.inks[1].low_95 <= table.inks[1].law && table.inks[1].law <= table.inks[1].high_95;
  }
  EXPECT_GE(holds, kSeeds - 8);  // one in a hundred is missed
  EXPECT_GE(inside, int(0.9 * kSeeds));
}

// The ratio is another than the one that was given; the law holds all the same.
TEST(StiffnessTableTest, AGivenRatioSaysNothingAgainstTheLaw) {
  int holds = 0;
  constexpr int kSeeds = 200;
  const Eigen::Vector3d more = 0.7 * Scan::law_slope() / Scan::law_slope().maxCoeff();
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scan scan(more, std::uint32_t(seed), true);
    holds += stiffness_table(scan.fit, kDensities, scan.by_ink).law_holds;
  }
  EXPECT_GE(holds, kSeeds - 8);
}

TEST(StiffnessTableTest, InkThatDoesNotIsFoundWithItsStiffness) {
  // At right angles to what another ratio would do.
  Eigen::Vector3d more(0.3, -0.3, 0.1);
  const Eigen::Vector3d law = Scan::law_slope();
  more -= law * law.dot(more) / law.squaredNorm();
  const Scan scan(more, 1);
  const StiffnessTable table = stiffness_table(scan.fit, kDensities, scan.by_ink);
  EXPECT_FALSE(table.law_holds);
  ASSERT_EQ(table.inks.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const InkStiffness& ink = table.inks[std::size_t(i)];
    EXPECT_DOUBLE_EQ(ink.law, 1 + 99 * ink.density);
    // The law's own best ratio is not far from the one it was made with.
    EXPECT_NEAR(std::log(ink.stiffness / ink.law), more[i], 0.15);
  }
  EXPECT_LT(table.inks[0].stiffness, table.inks[1].stiffness);
}

TEST(StiffnessTableTest, ItNeverFalls) {
  const Scan scan({0.5, -2.5, -0.5}, 2);
  const StiffnessTable table = stiffness_table(scan.fit, kDensities, scan.by_ink);
  EXPECT_LE(table.inks[0].stiffness, table.inks[1].stiffness);
  EXPECT_LE(table.inks[1].stiffness, table.inks[2].stiffness);
}

// The law bent at one ink: that ink is stiffer by the factor, the others are what they were.
TEST(StiffnessTableTest, AFilmWithOneStifferInk) {
  CheckeredFilm film;
  film.ink_density = {0, 0.005, 0.01, 0.055, 0.1, 1, 1.2};
  const CheckeredFilm bent = with_ink_stiffer(film, kDensities, 1, 2, 100);
  const auto stiffness = [](double density) { return 1 + density * 99; };
  EXPECT_NEAR(stiffness(bent.ink_density[0]), 1, 1e-12);
  EXPECT_NEAR(bent.ink_density[1], 0.005, 1e-12);
  EXPECT_NEAR(bent.ink_density[2], 0.01, 1e-12);
  EXPECT_NEAR(stiffness(bent.ink_density[4]), 2 * stiffness(0.1), 1e-9);
  EXPECT_NEAR(stiffness(bent.ink_density[3]), 0.5 * (stiffness(0.01) + 2 * stiffness(0.1)), 1e-9);
  EXPECT_NEAR(bent.ink_density[5], 1, 1e-12);
}

}  // namespace
}  // namespace hydrodip
