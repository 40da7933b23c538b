#include "calibrate/tear_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "calibrate/kit_shapes.h"
#include "object/surface.h"

namespace hydrodip {
namespace {

DesignOptions quick_design() {
  DesignOptions design;
  design.film.elements = 8000;
  design.dip.step_mm = 0.5;
  return design;
}

// The innermost ring on which a dip with a tear limit leaves no film somewhere.
int torn_from(const DesignOptions& design, double limit, const RunContext& context) {
  const CalibrationObject dome = tear_dome();
  const Surface surface(dome.object.positions, dome.object.triangles);
  DipOptions options = design.dip;
  options.material.tear_stretch = limit;
  const auto mesh = std::make_shared<const FilmMesh>(make_film_mesh(design.film));
  const DippedFilm film =
      dip(mesh, dome.object.positions, dome.object.triangles, surface,
          make_trajectory({dome.depth_mm}, dome.object.positions), options, context)
          .film;
  const FilmMap map(dome.object, surface, film);
  for (int ring = 1; ring <= kDomeRings; ++ring)
    for (int i = 0; i < 90; ++i) {
      const double angle = ring_arc_mm(ring) / kDomeRadius_mm, way = 2 * std::numbers::pi * i / 90;
      const Vec3 p(kDomeRadius_mm * std::sin(angle) * std::cos(way),
                   kDomeRadius_mm * std::sin(angle) * std::sin(way),
                   kDomeRadius_mm * (1 - std::cos(angle)));
      const auto hit = surface.closest_point(p, 1);
      if (hit && !map.to_film(surface.position(*hit), surface.normal(*hit))) return ring;
    }
  return kDomeRings + 1;
}

// The tear itself is simulated; who reads it is a ring off.
TEST(TearLimitSlow, IsFoundAgainFromReadingsThatAreARingOff) {
  RunContext context;
  const DesignOptions design = quick_design();
  const std::vector<double> stretches = ring_stretches(design, film_parameters(design), context);
  for (const double limit : {1.25, 1.4, 1.5}) {
    const int ring = torn_from(design, limit, context);
    for (const int off : {-1, 0, 1}) {
      const TearLimit found = tear_limit(stretches, {ring + off}).value();
      EXPECT_NEAR(found.stretch, limit, 0.03) << ring << " " << off;
      EXPECT_LE(found.low, limit);
      EXPECT_GE(found.high, limit);
    }
  }
}

TEST(TearLimitTest, SeveralReadingsAreSurerAndOthersAreRefused) {
  std::vector<double> stretches;
  for (int ring = 1; ring <= kDomeRings; ++ring) stretches.push_back(1 + 0.02 * ring);
  const TearLimit one = tear_limit(stretches, {12}).value(),
                  four = tear_limit(stretches, {11, 12, 12, 13}).value();
  EXPECT_NEAR(one.stretch, 1.23, 1e-12);
  EXPECT_NEAR(four.stretch, 1.23, 1e-12);
  EXPECT_NEAR(four.high - four.low, 0.5 * (one.high - one.low), 1e-3);
  for (const int ring : {-1, 0, 1, kDomeRings + 1})
    EXPECT_THROW(tear_limit(stretches, {ring}), InputError);
}

// A reading is off by a ring, as a standard deviation, and the limit lies somewhere in its ring's
// width; readings that differ by more than that say how sure they are themselves.
TEST(TearLimitTest, IsAsSureAsItsReadings) {
  constexpr double kRing = 0.02;
  std::vector<double> stretches;
  for (int ring = 1; ring <= kDomeRings; ++ring) stretches.push_back(1 + kRing * ring);
  const TearLimit one = tear_limit(stretches, {12}).value();
  EXPECT_NEAR(one.high - one.stretch, 1.96 * kRing * std::sqrt(1 + 1.0 / 12), 1e-12);
  EXPECT_NEAR(one.stretch - one.low, one.high - one.stretch, 1e-12);
  const TearLimit two = tear_limit(stretches, {6, 18}).value();
  EXPECT_NEAR(two.stretch, one.stretch, 1e-12);
  EXPECT_NEAR(two.high - two.stretch, 1.96 * 0.5 * 12 * kRing, 1e-12);
  EXPECT_EQ(tear_limit(stretches, {2}).value().low, 1);  // no film tears before it is stretched
}

// Stretches never fall, and may stand still from one ring to the next.
TEST(TearLimitTest, IsNeverSaidWithoutDoubt) {
  std::vector<double> stretches;
  for (int ring = 1; ring <= kDomeRings; ++ring) stretches.push_back(1 + 0.02 * (ring / 2));
  for (int ring = 2; ring <= kDomeRings; ++ring) {
    const auto found = tear_limit(stretches, {ring});
    ASSERT_TRUE(found) << ring;
    EXPECT_GT(found->high - found->low, 0.01) << ring;
    EXPECT_LE(found->low, stretches[std::size_t(ring - 2)]) << ring;
    EXPECT_GE(found->high, stretches[std::size_t(ring - 1)]) << ring;
  }
  EXPECT_FALSE(tear_limit(std::vector<double>(kDomeRings, 1.3), {9, 9}));
}

// The printed dome is the simulated one but for its grooves.
TEST(TearDomeTest, IsPrintedAsItIsDipped) {
  Object printed = dome_to_print();
  const double top = printed.bounds().max.z();
  for (Vec3& p : printed.positions) p = Vec3(p.x(), -p.y(), top - p.z());
  const Surface surface(printed.positions, printed.triangles);
  const CalibrationObject dome = tear_dome();
  for (const Vec3& p : dome.object.positions) {
    if (p.z() > dome.depth_mm) continue;
    const auto hit = surface.closest_point(p, 1);
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->t, 0.3);
  }
  // Ring 6 is one of the wide ones, and a groove.
  const double angle = ring_arc_mm(5) / kDomeRadius_mm;
  const Vec3 groove(kDomeRadius_mm * std::sin(angle), 0, kDomeRadius_mm * (1 - std::cos(angle)));
  const auto hit = surface.closest_point(groove, 1);
  ASSERT_TRUE(hit);
  EXPECT_GT(hit->t, 0.1);
}

}  // namespace
}  // namespace hydrodip
