#include "job/dips_report.h"

#include <gtest/gtest.h>

#include "samples/samples.h"

namespace hydrodip {
namespace {

DippedObject dip_with(double film_mm2, double stretch_max, double stretch_mean) {
  static const PosedObject posed(std::make_shared<const Object>(make_sample("box")), {});
  DippedObject dip{.posed = posed};
  dip.coverage.film_on_object_mm2 = film_mm2;
  dip.coverage.torn_mm2 = 10;
  dip.coverage.stretch_max = dip.coverage.area_ratio_max = stretch_max;
  dip.coverage.stretch_mean = dip.coverage.area_ratio_mean = stretch_mean;
  return dip;
}

// What is largest is so in whatever order the films come, and a mean is that of the film.
TEST(FilmsTogether, AreCountedByTheirAreasInAnyOrder) {
  const DippedObject much = dip_with(300, 1.3, 1.1), little = dip_with(100, 1.2, 1.18);
  for (const auto& films : {std::vector{&much, &little}, std::vector{&little, &much}}) {
    const Coverage sum = films_together(films);
    EXPECT_DOUBLE_EQ(sum.film_on_object_mm2, 400);
    EXPECT_DOUBLE_EQ(sum.torn_mm2, 20);
    EXPECT_DOUBLE_EQ(sum.stretch_max, 1.3);
    EXPECT_DOUBLE_EQ(sum.area_ratio_max, 1.3);
    EXPECT_DOUBLE_EQ(sum.stretch_mean, 1.12);
    EXPECT_DOUBLE_EQ(sum.area_ratio_mean, 1.12);
  }
}

// No dip is in the way of all for what it tears, which another may bring, or leaves bare.
TEST(Obstacle, OfOneOfSeveralIsNotWhatItTears) {
  DippedObject dip = dip_with(100, 1.2, 1.1);
  dip.coverage.object_mm2 = dip.coverage.downward_mm2 = 5000;
  dip.coverage.torn_mm2 = 900;
  dip.air = std::make_shared<const TrappedAir>();
  EXPECT_FALSE(obstacle_of(dip, nullptr, 1.4, 2, 3));
  dip.coverage.film_on_object_mm2 = 0;  // all of it
  EXPECT_FALSE(obstacle_of(dip, nullptr, 1.4, 2, 3));
  dip.coverage.film_on_object_mm2 = 100;
  TrappedAir air;
  air.pockets.resize(1);
  air.pockets[0].area_mm2 = 1000;
  dip.air = std::make_shared<const TrappedAir>(air);
  const auto obstacle = obstacle_of(dip, nullptr, 1.4, 2, 3);
  ASSERT_TRUE(obstacle);
  EXPECT_TRUE(obstacle->forbids);
  EXPECT_EQ(obstacle->what, "Trapped air: 1000 mm2");
  EXPECT_FALSE(obstacle_of(dip, nullptr, 1.4, 1, 1)) << "its own report says it";
}

}  // namespace
}  // namespace hydrodip
