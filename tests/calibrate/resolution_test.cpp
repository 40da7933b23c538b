#include "calibrate/resolution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

TEST(CorrectionTest, LeadsToTheLimitOfErrorsThatFallAsTheSquareOfTheCells) {
  const Eigen::VectorXd limit = Eigen::VectorXd::Random(5), slope = Eigen::VectorXd::Random(5);
  const auto on_cells_of = [&](double size) {
    return Eigen::VectorXd(limit + size * size * slope);
  };
  const Eigen::VectorXd here = on_cells_of(0.4);
  const Correction found = correction(on_cells_of(0.2) - here);
  EXPECT_LT((here + found.all - limit).norm(), 1e-12);
}

// However errors fall between the cells' size and its square, the limit is within the doubt.
TEST(CorrectionTest, DoubtReachesTheLimitOfErrorsThatFallAsTheCells) {
  const Eigen::VectorXd limit = Eigen::VectorXd::Random(5), slope = Eigen::VectorXd::Random(5);
  for (const double order : {1.0, 1.3, 1.7, 2.0}) {
    const auto on_cells_of = [&](double size) {
      return Eigen::VectorXd(limit + std::pow(size, order) * slope);
    };
    const Eigen::VectorXd here = on_cells_of(0.4);
    const Correction found = correction(on_cells_of(0.2) - here);
    const Eigen::ArrayXd missed = (here + found.all - limit).array().abs();
    EXPECT_TRUE((missed <= found.doubt.array().abs() + 1e-12).all()) << order;
  }
}

TEST(FinerFilmTest, HalvesCellsAndSteps) {
  DesignOptions design;
  design.film.elements = 10000;
  design.dip.step_mm = 0.2;
  const DesignOptions finer = finer_film(design);
  EXPECT_EQ(finer.film.elements, 40000);
  EXPECT_DOUBLE_EQ(finer.dip.step_mm, 0.1);
}

}  // namespace
}  // namespace hydrodip
