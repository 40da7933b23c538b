// The line along which film tears first on a body of revolution is a circle at a known height.
#include "exact/tear_lines.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

// The table of the sphere of 30 mm on the disc of 100 mm: a second derivation gave 10.775 and
// 13.645 mm.
TEST(TearLine, ExactHeightsOnTheSphere) {
  const exact::TearingBody sphere = exact::tearing_bodies()[0];
  EXPECT_NEAR(exact::tear_height(sphere, 1.3), 10.775, 0.002);
  EXPECT_NEAR(exact::tear_height(sphere, 1.4), 13.645, 0.002);
}

class TearLineSlow : public ::testing::TestWithParam<int> {};

TEST_P(TearLineSlow, IsASmoothCircleAtTheExactHeight) {
  const exact::TearingBody body = exact::tearing_bodies()[std::size_t(GetParam())];
  SCOPED_TRACE(body.name);
  const exact::TearLine coarse = exact::tear_line(body, 1.4, 10000, 0.2);
  EXPECT_LT(std::abs(coarse.mean_mm - coarse.exact_mm), 0.05);
  EXPECT_LT(coarse.deviation_mm, 0.05);
  EXPECT_LT(coarse.highest_mm - coarse.lowest_mm, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Bodies, TearLineSlow, ::testing::Range(0, 3));

TEST(TearLineSlow, ComesNearerOnFinerFilm) {
  const exact::TearingBody sphere = exact::tearing_bodies()[0];
  const auto worst = [&](int elements) {
    const exact::TearLine line = exact::tear_line(sphere, 1.4, elements, 0.2);
    return std::max(line.highest_mm - line.exact_mm, line.exact_mm - line.lowest_mm);
  };
  EXPECT_LT(worst(24000), 0.7 * worst(3000));
}

}  // namespace
}  // namespace hydrodip
