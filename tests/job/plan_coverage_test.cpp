#include "job/plan_coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/cups.h"
#include "contains.h"
#include "job/ways.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr double kRadius_mm = 30, kDepth_mm = 12;
// Of a sphere's surface that goes into the water.
constexpr double kCap = kDepth_mm / (2 * kRadius_mm);

JobConfig coarse_job() {
  JobConfig config;
  config.design.film.width_mm = config.design.film.height_mm = 160;
  config.design.film.elements = 4000;
  config.design.dip.step_mm = 1;
  config.design.dip.material.tear_stretch = 0;
  config.design.air.cells = 20000;
  return config;
}

PreparedObject hung(std::shared_ptr<const Object> object) {
  PosedObject posed(object, {});
  return {.posed = std::move(posed),
          .paint = model_paint(object),
          .health = {},
          .units = "mm",
          .files = {},
          .artwork = {},
          .picture_problems = {}};
}

// Colours on the model's lower half, and the bare object's elsewhere.
std::shared_ptr<const Object> half_coloured(Object object) {
  object.materials = {{}};
  object.material_of.assign(object.triangles.size(), 0);
  object.textures.clear();
  object.uvs.clear();
  object.colors.clear();
  const double middle = object.bounds().center().z();
  for (const Triangle& t : object.triangles) {
    double z = 0;
    for (const std::int32_t v : t) z += object.positions[std::size_t(v)].z() - middle;
    const LinearColor color = z < 0 ? LinearColor{0.5F, 0, 0, 1} : LinearColor{1, 1, 1, 1};
    object.colors.push_back({color, color, color});
  }
  return std::make_shared<const Object>(std::move(object));
}

std::shared_ptr<const Object> sphere() {
  return std::make_shared<const Object>(make_sample("sphere"));
}

DipEntry dip_of(ModelSide down, double depth_mm, const Vec3& rotate_deg = Vec3::Zero()) {
  DipEntry entry;
  entry.down = down;
  entry.rotate_deg = rotate_deg;
  entry.depth_mm = depth_mm;
  return entry;
}

struct Planned {
  DipPlan plan;
  PlanCoverage coverage;
  std::vector<Finding> told;
};

Planned planned(const std::shared_ptr<const Object>& object, JobConfig config,
                std::vector<DipEntry> dips) {
  config.dips = std::move(dips);
  const PreparedObject prepared = hung(object);
  const RunContext context;
  const Targets targets = job_targets(config, prepared, context);
  Planned result{plan_dips(config, prepared, targets, false, context), {}, {}};
  result.coverage = coverage_of(result.plan, config, prepared);
  result.told = foretold(result.plan, result.coverage, config);
  return result;
}

const Finding* find(const std::vector<Finding>& list, const std::string& key) {
  for (const Finding& finding : list)
    if (finding.key == key) return &finding;
  return nullptr;
}

// Two caps of a sphere that does not tear are all that comes to film, and each adds its own.
TEST(PlanCoverage, OppositeDipsOfASphereAddTheirCaps) {
  const auto [plan, coverage, told] =
      planned(sphere(), coarse_job(),
              {dip_of(ModelSide::kMinusZ, kDepth_mm), dip_of(ModelSide::kPlusZ, kDepth_mm)});
  ASSERT_EQ(coverage.covered_share.size(), 2U);
  for (const std::size_t k : {0, 1}) {
    const double own = plan.dips[k].blank.coverage.covered_share();
    EXPECT_NEAR(gained(coverage.covered_share, k), own, 0.01) << k;
    EXPECT_NEAR(own, kCap, 0.15 * kCap) << k;  // film ends a cell or so short
  }
  ASSERT_TRUE(coverage.everywhere);
  EXPECT_NEAR(coverage.everywhere->reached_mm2 / coverage.everywhere->object_mm2, 2 * kCap,
              0.02 * kCap);
  EXPECT_NEAR(coverage.everywhere->covered_share(), coverage.covered_share.back(), 1e-12);
  EXPECT_FALSE(coverage.wanted) << "colours everywhere";
}

TEST(PlanCoverage, ADipThatIsMadeAgainAddsNothing) {
  const auto [plan, coverage, told] =
      planned(sphere(), coarse_job(),
              {dip_of(ModelSide::kMinusZ, kDepth_mm), dip_of(ModelSide::kMinusZ, kDepth_mm)});
  EXPECT_GT(coverage.covered_share[0], 0.85 * kCap);
  EXPECT_EQ(gained(coverage.covered_share, 1), 0);
  ASSERT_NE(find(told, "idle_dips"), nullptr);
  EXPECT_EQ(find(told, "idle_dips")->figure, "2");
}

TEST(PlanCoverage, OfASingleDipItIsTheFilms) {
  const auto [plan, coverage, told] =
      planned(sphere(), coarse_job(), {dip_of(ModelSide::kMinusZ, kDepth_mm)});
  EXPECT_EQ(coverage.covered_share,
            std::vector<double>{plan.dips.front().blank.coverage.covered_share()});
  EXPECT_FALSE(coverage.everywhere);
}

// A picture on the lower half: the upper dip brings nothing of it.
TEST(PlanCoverage, WhatShallBePrintedIsCountedByItself) {
  const auto [plan, coverage, told] =
      planned(half_coloured(make_sample("sphere")), coarse_job(),
              {dip_of(ModelSide::kMinusZ, kDepth_mm), dip_of(ModelSide::kPlusZ, kDepth_mm)});
  ASSERT_TRUE(coverage.wanted);
  ASSERT_EQ(coverage.covered_wanted_share.size(), 2U);
  EXPECT_NEAR(coverage.wanted->object_mm2, 0.5 * coverage.everywhere->object_mm2,
              0.01 * coverage.everywhere->object_mm2);
  EXPECT_NEAR(coverage.covered_wanted_share[0], 2 * coverage.covered_share[0], 0.01);
  EXPECT_EQ(gained(coverage.covered_wanted_share, 1), 0);
  EXPECT_GT(gained(coverage.covered_share, 1), 0.85 * kCap);
  EXPECT_NEAR(coverage.wanted->covered_share(), coverage.covered_wanted_share.back(), 1e-12);
  ASSERT_NE(find(told, "idle_dips"), nullptr);
}

// Film that bears next to nothing: what comes to it and gets none is missed, and what a print would
// say of that is said.
TEST(PlanCoverage, WhatLiesUnderTornFilmIsMissed) {
  JobConfig config = coarse_job();
  config.design.dip.material.tear_stretch = 1.08;
  const auto [plan, coverage, told] =
      planned(sphere(), config, {dip_of(ModelSide::kMinusZ, 28), dip_of(ModelSide::kPlusZ, 28)});
  const double reached = 2 * 28 / (2 * kRadius_mm);
  EXPECT_NEAR(coverage.everywhere->reached_mm2 / coverage.everywhere->object_mm2, reached, 0.02);
  EXPECT_NEAR(coverage.everywhere->covered_share(), coverage.covered_share.back(), 1e-12);
  const double missed = 1 - coverage.covered_share.back() / reached;
  EXPECT_NEAR(coverage.everywhere->missed_share(), missed, 0.03);
  ASSERT_GT(missed, 0.5);
  ASSERT_NE(find(told, "tears"), nullptr);
  EXPECT_EQ(find(told, "tears")->concern, Concern::kStop);
  EXPECT_TRUE(contains(find(told, "tears")->text, "of the surface that comes to a film"));
}

// Nearly the same dip again: most of its film tears, as did the first one's, and what it adds is a
// rim.
TEST(PlanCoverage, ADipThatIsHardlyWorthItsFilmIsForetold) {
  JobConfig config = coarse_job();
  config.design.dip.material.tear_stretch = 1.08;
  const auto [plan, coverage, told] =
      planned(sphere(), config,
              {dip_of(ModelSide::kMinusZ, 28), dip_of(ModelSide::kMinusZ, 28, Vec3(5, 0, 0))});
  ASSERT_GT(plan.dips[1].blank.coverage.torn_share(), 0.5);
  ASSERT_GT(gained(coverage.covered_share, 1), 0.002);
  ASSERT_LT(gained(coverage.covered_share, 1), 0.03);
  ASSERT_NE(find(told, "poor_dips"), nullptr);
  EXPECT_EQ(find(told, "poor_dips")->figure, "2");
}

// A cup with its mouth down keeps its air, whichever of the dips it is.
TEST(PlanCoverage, AirThatADipWillTrapIsForetold) {
  const shapes::Shape cup = cups::turned(cups::kCup);
  Object object;
  object.positions = cup.positions;
  object.triangles = cup.triangles;
  object.materials = {{}};
  object.material_of.assign(object.triangles.size(), 0);
  const auto shared = std::make_shared<const Object>(std::move(object));
  const auto alone = planned(shared, coarse_job(), {dip_of(ModelSide::kMinusZ, 10)});
  ASSERT_NE(find(alone.told, "air"), nullptr);
  EXPECT_EQ(find(alone.told, "air")->concern, Concern::kStop);
  const auto second = planned(shared, coarse_job(),
                              {dip_of(ModelSide::kPlusZ, 10), dip_of(ModelSide::kMinusZ, 10)});
  EXPECT_EQ(find(second.told, "air"), nullptr);
  ASSERT_NE(find(second.told, "dip"), nullptr);
  EXPECT_EQ(find(second.told, "dip")->title, "Dip 2");
  EXPECT_TRUE(contains(find(second.told, "dip")->figure, "Trapped air"));
}

}  // namespace
}  // namespace hydrodip
