#include "object/dip_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "samples/samples.h"

namespace hydrodip {
namespace {

double sum(const DipAngles& angles) {
  return std::accumulate(angles.area_mm2.begin(), angles.area_mm2.end(), 0.0);
}

TEST(DipAngles, AreMeasuredFromTheDippingDirection) {
  EXPECT_NEAR(dip_angle_deg({0, 0, -1}), 0, 1e-12);
  EXPECT_NEAR(dip_angle_deg({1, 0, 0}), 90, 1e-12);
  EXPECT_NEAR(dip_angle_deg({0, 0, 1}), 180, 1e-12);
  EXPECT_NEAR(dip_angle_deg(Vec3(1, 0, -1).normalized()), 45, 1e-12);
}

// Archimedes: a sphere's area between two angles is 2 pi R^2 (cos a - cos b).
TEST(DipAngles, OfASphereFollowArchimedes) {
  const DipAngles angles = dip_angles(make_sample("sphere"), 1e9);
  const double radius = 30, pi = std::numbers::pi;
  const double sphere = 4 * pi * radius * radius;
  EXPECT_NEAR(angles.downward_mm2, sphere / 2, 0.01 * sphere);
  EXPECT_NEAR(angles.downward_mm2 + angles.upward_mm2, sphere, 0.005 * sphere);
  EXPECT_NEAR(sum(angles), angles.downward_mm2, 1e-9 * sphere);
  EXPECT_NEAR(angles.over_limit_share(), std::cos(45 * pi / 180), 0.01);
  for (int bin = 0; bin < DipAngles::kBins; ++bin) {
    const double share = std::cos(bin * pi / 18) - std::cos((bin + 1) * pi / 18);
    EXPECT_NEAR(angles.area_mm2[std::size_t(bin)] / angles.downward_mm2, share, 0.01) << bin;
  }
}

TEST(DipAngles, OnlyTheWetPartCounts) {
  Object sphere = make_sample("sphere");
  const double bottom = sphere.bounds().min.z();
  for (Vec3& p : sphere.positions) p.z() -= bottom;
  // A cap of height h has the area 2 pi R h.
  const DipAngles cap = dip_angles(sphere, 12);
  EXPECT_NEAR(cap.downward_mm2, 2 * std::numbers::pi * 30 * 12, 100);
  EXPECT_EQ(cap.upward_mm2, 0);
}

// Apex down, walls at 45 degrees to the dipping direction, open above.
Object cone_of_45_degrees(int facets) {
  Object cone;
  cone.positions.emplace_back(0, 0, 0);
  for (int i = 0; i < facets; ++i) {
    const double turn = 2 * std::numbers::pi * i / facets;
    cone.positions.emplace_back(20 * std::cos(turn), 20 * std::sin(turn), 20);
    cone.triangles.push_back({0, 1 + (i + 1) % facets, 1 + i});
  }
  return cone;
}

TEST(DipAngles, AConeOf45DegreesLiesAtTheLimitNotBeyondIt) {
  const DipAngles angles = dip_angles(cone_of_45_degrees(64), 20);
  EXPECT_NEAR(angles.downward_mm2, std::numbers::pi * 20 * 20 * std::sqrt(2), 5);
  EXPECT_EQ(angles.upward_mm2, 0);
  EXPECT_EQ(angles.over_limit_mm2, 0);
  Object steeper = cone_of_45_degrees(64);
  for (Vec3& p : steeper.positions) p.z() *= 1.01;
  EXPECT_EQ(dip_angles(steeper, 30).over_limit_share(), 1);
}

TEST(DipAngles, AVerticalWallDoesNotFaceDownWhateverRoundingMakesOfIt) {
  for (const double lean : {-1e-9, 0.0, 1e-9}) {
    Object wall;
    wall.positions = {{0, 0, 0}, {0, 10, 0}, {lean, 0, 10}};
    wall.triangles = {{0, 1, 2}};
    EXPECT_EQ(dip_angles(wall, 10).downward_mm2, 0) << lean;
    EXPECT_NEAR(dip_angles(wall, 10).upward_mm2, 50, 1e-6) << lean;
  }
}

TEST(DipAngles, OfNothingAreZero) {
  const DipAngles none = dip_angles(Object{}, 10);
  EXPECT_EQ(none.downward_mm2, 0);
  EXPECT_EQ(none.over_limit_share(), 0);
}

}  // namespace
}  // namespace hydrodip
