#include "calibrate/subject.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "calibrate/calibrate.h"
#include "contains.h"
#include "refusal.h"
#include "scans.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

// What a store holds is taken for whatever has the same fingerprint.
TEST(Subject, WhateverChangesADipChangesItsFingerprint) {
  const TemporaryFolder folder;
  const RunContext context;
  const scans::Truth truth("sphere", {0.65, 30, 0.1}, context);
  const std::filesystem::path file = folder / "scan.csv";
  truth.write(file, {});
  const auto fingerprint = [&](const JobConfig& config, const std::string& depth = "") {
    const std::string text = "sphere" + depth + "=" + file.string();
    return load_subjects({text}, scans::settings(), config, context).front().fingerprint;
  };
  const std::function<void(JobConfig&)> changes[] = {
      [](JobConfig& c) { c.design.film.width_mm += 1; },
      [](JobConfig& c) { c.design.film.height_mm += 1; },
      [](JobConfig& c) { c.design.film.margin_mm += 1; },
      [](JobConfig& c) { c.design.film.shape = FilmShape::kDisc; },
      [](JobConfig& c) { c.design.film.elements += 100; },
      [](JobConfig& c) { c.design.film.grading += 1; },
      [](JobConfig& c) { c.design.film.swelling_x += 0.01; },
      [](JobConfig& c) { c.design.film.swelling_y += 0.01; },
      [](JobConfig& c) { c.design.dip.step_mm += 0.1; },
      [](JobConfig& c) { c.design.dip.even_steps = true; },
      [](JobConfig& c) { c.design.dip.scheme = DipScheme::kPaper; },
      [](JobConfig& c) { c.design.stiffness.filter_mm += 0.1; }};
  const JobConfig config = scans::quick_config();
  std::set<std::string> all = {fingerprint(config), fingerprint(config, "@10")};
  for (const auto& change : changes) {
    JobConfig changed = config;
    change(changed);
    all.insert(fingerprint(changed));
  }
  EXPECT_EQ(all.size(), 2 + std::size(changes));
  // The parameters are asked for one by one.
  JobConfig other = config;
  other.design.dip.material.z_stretch = 0.8;
  other.design.stiffness.ratio = 10;
  EXPECT_TRUE(all.contains(fingerprint(other)));
}

TEST(Subject, ABoardIsPrintedWithoutAJobsCorrection) {
  const TemporaryFolder folder;
  JobConfig config = scans::quick_config();
  config.output = folder / "none";
  auto correction = std::make_shared<FilmCorrection>();
  correction->nx = correction->ny = 1;
  correction->move = {{1, 0}};
  config.design.film.correction = correction;
  const RunContext context;
  CalibrationRequest request;
  request.scans = {"sphere"};
  for (const auto& job : {calibrate_job, measure_job, synth_job, kit_job}) {
    const std::string why = refusal([&] { job(config, request, context); });
    EXPECT_TRUE(contains(why, "film.correction")) << why;
  }
  EXPECT_FALSE(std::filesystem::exists(config.output));
}

}  // namespace
}  // namespace hydrodip
