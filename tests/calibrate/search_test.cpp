#include "calibrate/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "scans.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

const FilmParameters kTruth{0.65, 30, 0.1};

class SearchSlow : public testing::Test {
 protected:
  // Scans of two shapes, in random poses.
  std::vector<Subject> subjects(const SyntheticOptions& options,
                                const std::vector<std::string>& names) {
    std::vector<std::string> texts;
    for (const std::string& name : names) {
      const std::filesystem::path file = folder_ / (name + ".csv");
      truth(name).write(file, options);
      texts.push_back(name + "=" + file.string());
    }
    return load_subjects(texts, scans::settings(), scans::quick_config(), context_);
  }

  static const scans::Truth& truth(const std::string& name) {
    static RunContext context;
    static const scans::Truth sphere("sphere", kTruth, context);
    EXPECT_EQ(name, "sphere");
    return sphere;
  }

  Calibration calibrate(const std::vector<Subject>& scanned, const GridSearchOptions& options,
                        const std::string& store_name,
                        const std::vector<std::filesystem::path>& merged = {}) {
    SimulationStore store(folder_ / store_name, merged);
    RunContext context;
    return Search(scanned, scans::quick_config().design, scans::board(), options, store)
        .run(context);
  }

  static void expect_same(const Calibration& a, const Calibration& b) {
    ASSERT_EQ(a.grid.size(), b.grid.size());
    for (std::size_t p = 0; p < a.grid.size(); ++p) {
      EXPECT_EQ(a.grid[p].all_mm, b.grid[p].all_mm);
      EXPECT_EQ(a.grid[p].rms_mm, b.grid[p].rms_mm);
    }
    EXPECT_EQ(a.all.fit.point, b.all.fit.point);
    EXPECT_EQ(a.all.certainty.covariance, b.all.certainty.covariance);
    EXPECT_EQ(a.correction_mm, b.correction_mm);
    for (std::size_t s = 0; s < a.error.size(); ++s) {
      EXPECT_EQ(a.error[s].rms_mm, b.error[s].rms_mm);
      EXPECT_EQ(a.each[s].fit.point, b.each[s].fit.point);
    }
  }

  TemporaryFolder folder_;
  RunContext context_;
};

// A scan made by the very film that it is fitted with, so that nothing but noise is in it.
class OwnFilmSlow : public SearchSlow {
 protected:
  explicit OwnFilmSlow(const std::string& name = "pyramid") : name_(name) {
    config_.design.film.elements = 6000;
    config_.design.dip.step_mm = 0.5;
    object_ = calibration_object(name_, config_, context_);
    surface_.emplace(object_->object.positions, object_->object.triangles);
    dip_ = dip_checkerboard(checkered_film(config_.design, scans::board()), *object_, *surface_,
                            kTruth, config_.design.dip, context_);
  }

  Calibration fit(const SyntheticOptions& scan, GridSearchOptions options) {
    const std::filesystem::path file = folder_ / "own.csv";
    write_scan_table(file, synthetic_scan(dip_->landing(*object_), {12, 12}, scan), kSyntheticMark);
    const std::vector<Subject> scanned =
        load_subjects({name_ + "=" + file.string()}, scans::settings(), config_, context_);
    options.elements_factor = options.step_factor = 1;
    options.correct = false;
    SimulationStore store(folder_ / "own.jsonl", {});
    return Search(scanned, config_.design, scans::board(), options, store).run(context_);
  }

  std::string name_;
  JobConfig config_ = scans::quick_config();
  std::optional<CalibrationObject> object_;
  std::optional<Surface> surface_;
  std::optional<CheckerboardDip> dip_;
};

TEST_F(OwnFilmSlow, WithoutNoiseTheAnswerIsTheTruth) {
  GridSearchOptions options;
  options.z_stretch = {0.5, 0.6, 0.7};
  options.stiffness_ratio = {10, 160};
  options.poisson = {0, 0.3};
  const Calibration found = fit({}, options);
  EXPECT_NEAR(found.all.parameters.z_stretch, kTruth.z_stretch, 0.002);
  EXPECT_NEAR(found.all.parameters.stiffness_ratio, kTruth.stiffness_ratio,
              0.1 * kTruth.stiffness_ratio);
  EXPECT_NEAR(found.all.parameters.poisson, kTruth.poisson, 0.02);
  // A tenth of a scan's noise: as much as the ratio's tolerance moves corners.
  EXPECT_LT(found.error[0].rms_mm, 0.005);
}

// The long study, with the film's resolution in it, is bench/calibrate/noise.cpp.
class OwnSphereSlow : public OwnFilmSlow {
 protected:
  OwnSphereSlow() : OwnFilmSlow("sphere") {}
};

TEST_F(OwnSphereSlow, NoiseStaysWithinTheStatedUncertainty) {
  int covered = 0;
  constexpr int kSeeds = 8;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Answer found =
        fit({.noise_mm = 0.05, .seed = std::uint64_t(seed)}, scans::around(kTruth)).all;
    EXPECT_NEAR(found.certainty.noise_mm, 0.05, 0.02);
    covered += found.certainty.low.z_stretch <= kTruth.z_stretch &&
               kTruth.z_stretch <= found.certainty.high.z_stretch;
  }
  EXPECT_GE(covered, kSeeds - 1) << "a 95 % interval misses once in twenty";
}

// Simulations know nothing of scans: a second scan of the same object costs none.
TEST_F(OwnFilmSlow, NoiseLeavesAllThreeKnownAndScansShareTheirSimulations) {
  GridSearchOptions options;
  options.z_stretch = {0.6, 0.7};
  options.stiffness_ratio = {20, 80};
  options.poisson = {0, 0.3};
  std::size_t simulations = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Calibration found = fit({.noise_mm = 0.05, .seed = seed}, options);
    EXPECT_NEAR(found.all.parameters.z_stretch, kTruth.z_stretch, 0.015) << seed;
    EXPECT_NEAR(std::log(found.all.parameters.stiffness_ratio / kTruth.stiffness_ratio), 0,
                std::log(1.6))
        << seed;
    EXPECT_LT(found.all.certainty.high.stiffness_ratio, 5 * kTruth.stiffness_ratio) << seed;
    EXPECT_NEAR(found.all.certainty.noise_mm, 0.05, 0.01) << seed;
    EXPECT_LT(found.all.film_off_mm[0].norm(), 0.2);
    for (const InkMisfit& ink : found.all.by_ink)
      EXPECT_LT(std::abs(ink.more_stretch), 4 * ink.deviation + 1e-3) << ink.density;
    if (seed == 1) simulations = found.simulations;
    // Some for stencils around another node with their inks, one for the error at the answer.
    EXPECT_LE(found.simulations, simulations + 15 * std::size_t(seed));
  }
}

TEST_F(SearchSlow, InterruptedAnywhereItEndsTheSame) {
  const std::vector<Subject> scanned = subjects({.noise_mm = 0.05}, {"sphere"});
  const GridSearchOptions options = scans::around(kTruth);
  const Calibration whole = calibrate(scanned, options, "whole.jsonl");
  std::size_t kept = 0;
  for (const int reports : {2, 5, 9}) {
    SimulationStore store(folder_ / "broken.jsonl", {});
    RunContext context;
    int seen = 0;
    context.on_progress([&](const std::string&, double) {
      if (++seen >= reports) context.cancel();
    });
    EXPECT_THROW(
        Search(scanned, scans::quick_config().design, scans::board(), options, store).run(context),
        Cancelled);
    EXPECT_GE(store.size(), kept);
    kept = store.size();
  }
  EXPECT_GT(kept, 0u);
  expect_same(calibrate(scanned, options, "broken.jsonl"), whole);
  // Nothing is computed twice.
  EXPECT_EQ(SimulationStore(folder_ / "broken.jsonl", {}).size(),
            SimulationStore(folder_ / "whole.jsonl", {}).size());
}

TEST_F(SearchSlow, ShardsMergedAreOneRun) {
  const std::vector<Subject> scanned = subjects({.noise_mm = 0.05}, {"sphere"});
  const GridSearchOptions options = scans::around(kTruth);
  const Calibration whole = calibrate(scanned, options, "whole.jsonl");
  std::vector<std::filesystem::path> stores;
  for (const int number : {1, 2}) {
    stores.push_back(folder_ / ("shard" + std::to_string(number)));
    SimulationStore store(stores.back(), {});
    RunContext context;
    Search search(scanned, scans::quick_config().design, scans::board(), options, store);
    search.simulate_grid({number, 2}, context);
    EXPECT_EQ(search.missing(), number == 1 ? 1u : 2u);
  }
  {
    SimulationStore store(folder_ / "merged.jsonl", stores);
    EXPECT_EQ(
        Search(scanned, scans::quick_config().design, scans::board(), options, store).missing(),
        0u);
  }
  expect_same(calibrate(scanned, options, "merged.jsonl", stores), whole);
}

TEST_F(SearchSlow, ThreadsDoNotMatter) {
  const std::vector<Subject> scanned = subjects({.noise_mm = 0.05}, {"sphere"});
  std::optional<Calibration> one;
  {
    const ThreadLimit limit(1);
    one = calibrate(scanned, scans::around(kTruth), "one.jsonl");
  }
  expect_same(calibrate(scanned, scans::around(kTruth), "many.jsonl"), *one);
}

}  // namespace
}  // namespace hydrodip
