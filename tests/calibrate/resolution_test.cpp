#include "calibrate/resolution.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

TEST(CorrectionTest, LeadsToTheLimitOfErrorsThatFallAsTheSquareOfTheCells) {
  const Eigen::VectorXd limit = Eigen::VectorXd::Random(5), slope = Eigen::VectorXd::Random(5);
  const auto on_cells_of = [&](double size) {
    return Eigen::VectorXd(limit + size * size * slope);
  };
  const Eigen::VectorXd here = on_cells_of(0.4), fine = on_cells_of(0.2), finest = on_cells_of(0.1);
  const Correction found = correction(here, fine, finest);
  EXPECT_LT((here + found.all - limit).norm(), 1e-12);
  EXPECT_LT((finest + found.guessed - limit).norm(), 1e-12);
}

TEST(FinerFilmTest, HalvesCellsAndSteps) {
  JobConfig config;
  config.film.elements = 10000;
  config.dip.step_mm = 0.2;
  const JobConfig finer = finer_film(config);
  EXPECT_EQ(finer.film.elements, 40000);
  EXPECT_DOUBLE_EQ(finer.dip.step_mm, 0.1);
}

}  // namespace
}  // namespace hydrodip
