#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "contains.h"
#include "job/jobs.h"
#include "refusal.h"
#include "sweep/scripts.h"
#include "sweep/sweep_jobs.h"
#include "sweep/sweep_table.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// A model that dips in a moment, and a place for sweeps over it.
class SweepTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_ / "tetrahedron.obj",
               std::string("v 0 0 0\nv 20 -20 14\nv 20 20 14\nv -20 0 14\n"
                           "f 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n"));
  }

  SweepPlan plan(const std::string& toml) {
    write_file(folder_ / "sweep.toml", toml);
    return read_sweep(folder_ / "sweep.toml", sweep());
  }
  std::string why(const std::string& toml) {
    return refusal([&] { plan(toml); });
  }
  fs::path sweep() {
    fs::create_directories(folder_ / "s");
    return folder_ / "s";
  }

  const TemporaryFolder folder_;
  const std::string head_ =
      "[sweep]\nmodels = [\"tetrahedron.obj\"]\nquality = \"draft\"\n"
      "[set]\n\"film.elements\" = 300\n\"dip.step_mm\" = 3\n\"dip.depth_mm\" = 9\n"
      "\"dip.air_cells\" = 0\n";
  const RunContext context_;
};

std::set<std::string> ids(const SweepPlan& plan) {
  std::set<std::string> all;
  for (const SweepRun& run : plan.runs) all.insert(run.id);
  return all;
}

TEST_F(SweepTest, AGridIsEveryCombination) {
  const SweepPlan grid = plan(head_ +
                              "[vary]\n\"material.z_stretch\" = [0.4, 0.5, 0.65]\n"
                              "\"dip.pivot_mm\" = [[0, 0, 0], [1, 2, 3]]\n"
                              "\"material.poisson\" = { from = 0, to = 0.3, count = 4 }\n");
  EXPECT_EQ(grid.runs.size(), 3U * 2 * 4);
  EXPECT_EQ(ids(grid).size(), grid.runs.size());
  std::set<std::vector<std::string>> combinations;
  for (const SweepRun& run : grid.runs)
    combinations.insert({value_of(run, "material.z_stretch"), value_of(run, "dip.pivot_mm"),
                         value_of(run, "material.poisson")});
  EXPECT_EQ(combinations.size(), grid.runs.size());
  EXPECT_TRUE(combinations.contains({"0.65", "1,2,3", "0.2"}));
  EXPECT_EQ(grid.varied.size(), 3U);
}

TEST_F(SweepTest, ARangeByEqualFactors) {
  const SweepPlan grid =
      plan(head_ +
           "[vary]\n\"material.ink_stiffness_ratio\" = { from = 1, to = 1000, count = 4, log = "
           "true }\n");
  std::vector<std::string> values;
  for (const SweepRun& run : grid.runs)
    values.push_back(value_of(run, "material.ink_stiffness_ratio"));
  EXPECT_EQ(values, (std::vector<std::string>{"1", "10", "100", "1000"}));
}

// Each of N equal parts of every range is used once.
TEST_F(SweepTest, ALatinHypercubeUsesEveryPartOfEveryAxisOnce) {
  const SweepPlan latin = plan(
      "[sweep]\nmethod = \"latin\"\nruns = 40\nseed = 7\nmodels = [\"tetrahedron.obj\"]\n"
      "[vary]\n\"material.z_stretch\" = { from = 0.2, to = 1 }\n"
      "\"material.tear_stretch\" = { from = 1.2, to = 2 }\n");
  ASSERT_EQ(latin.runs.size(), 40U);
  const auto parts = [&](const std::string& name, double from, double to) {
    std::set<int> seen;
    for (const SweepRun& run : latin.runs)
      seen.insert(int(40 * (std::stod(value_of(run, name)) - from) / (to - from)));
    return seen;
  };
  EXPECT_EQ(parts("material.z_stretch", 0.2, 1).size(), 40U);
  EXPECT_EQ(parts("material.tear_stretch", 1.2, 2).size(), 40U);
}

TEST_F(SweepTest, AnIdIsWhatTheRunIsMadeOf) {
  const std::string vary = "[vary]\n\"material.z_stretch\" = [0.4, 0.5]\n";
  const SweepPlan first = plan(head_ + vary);
  EXPECT_EQ(ids(plan(head_ + "[vary]\n\"material.z_stretch\" = [0.5, 0.4]\n")), ids(first));
  // A longer sweep has the same runs in it.
  const std::set<std::string> longer =
      ids(plan(head_ + "[vary]\n\"material.z_stretch\" = [0.5, 0.6, 0.4]\n"));
  for (const std::string& id : ids(first)) EXPECT_TRUE(longer.contains(id));
  // Another model is another run.
  std::ofstream(folder_ / "tetrahedron.obj", std::ios::app) << "# changed\n";
  for (const std::string& id : ids(plan(head_ + vary))) EXPECT_FALSE(ids(first).contains(id));
}

TEST_F(SweepTest, SaysWhatIsWrongInItsFile) {
  EXPECT_TRUE(contains(why(head_ + "[vary]\n\"material.zstretch\" = [1]\n"), "z_stretch"));
  EXPECT_TRUE(contains(why(head_ + "[vary]\n\"material.z_stretch\" = [7]\n"), "0 to 5"));
  EXPECT_TRUE(contains(why(head_ + "[vary]\n\"material.z_stretch\" = 7\n"), "list"));
  EXPECT_TRUE(
      contains(why(head_ + "[vary]\n\"material.z_stretch\" = { from = 0, to = 1 }\n"), "count"));
  EXPECT_TRUE(contains(why("[sweep]\nmodels = [\"gone.obj\"]\n"), "gone.obj"));
  EXPECT_TRUE(contains(why("[sweep]\nmodel = [\"tetrahedron.obj\"]\n"), "models"));
  EXPECT_TRUE(contains(why("[sweep]\nmethod = \"gird\"\n"), "grid"));
  EXPECT_TRUE(contains(why("[vary]\n\"dip.depth_mm\" = [3]\n"), "no model"));
  EXPECT_TRUE(
      contains(why("[sweep]\nmethod = \"list\"\nmodels = [\"tetrahedron.obj\"]\n"), "[[run]]"));
  EXPECT_TRUE(contains(why(head_ + "[vary]\n\"film.elements\" = { from = 8, to = 9, count = "
                                   "2000000000 }\n"),
                       "at most"));
  EXPECT_TRUE(contains(why("[sweep\n"), "TOML"));
  EXPECT_TRUE(contains(why("sweep = 3\n"), "table"));
}

TEST_F(SweepTest, TheManifestIsThePlan) {
  const SweepPlan made = plan(head_ + "[vary]\n\"material.z_stretch\" = [0.4, 0.5]\n");
  write_file(sweep() / "sweep.json", manifest_json(made));
  const SweepPlan read = read_manifest(sweep());
  EXPECT_EQ(manifest_json(read), manifest_json(made));
  write_file(sweep() / "sweep.json", std::string("{\"hydrodip_sweep\": 1}"));
  EXPECT_NE(refusal([&] { read_manifest(sweep()); }), "");
  std::string escaping = manifest_json(made);
  escaping.replace(escaping.find(made.runs[0].id), 16, "../../../../etc/");
  write_file(sweep() / "sweep.json", escaping);
  EXPECT_TRUE(contains(refusal([&] { read_manifest(sweep()); }), "no run's id"));
}

// But for where it was done, and how fast.
Json essence(const std::string& text) {
  Json report = Json::parse(text);
  for (const char* own : {"seconds", "peak_memory_bytes", "folder"}) report.erase(own);
  for (Json& input : report["inputs"]) input.erase("path");
  report["parameters"].erase("object.file");
  return report;
}

// A run of a sweep is the job that it names, done alone.
TEST_F(SweepTest, ARunIsTheJobAlone) {
  const SweepPlan made = plan(head_ + "[vary]\n\"material.z_stretch\" = [0.4, 0.5]\n");
  const SweepDone done = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(done.done, 2);
  for (const SweepRun& run : made.runs) {
    JobConfig config = sweep_config(made, run, sweep());
    config.threads = 1;
    config.output = folder_ / "alone";
    EXPECT_EQ(essence(read_outcome(sweep(), run.id)->report),
              essence(simulate_job(config, RunContext()).json));
  }
}

TEST_F(SweepTest, WhatIsDoneIsNotDoneAgain) {
  const SweepPlan made = plan(head_ + "[vary]\n\"material.z_stretch\" = [0.4, 0.5, 0.6]\n");
  EXPECT_EQ(run_sweep(sweep(), made, {{}, made.runs[1].id, false}, context_).done, 1);
  const auto before = fs::last_write_time(sweep() / "runs" / (made.runs[1].id + ".json"));
  const SweepDone rest = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(rest.done, 2);
  EXPECT_EQ(rest.before, 1);
  EXPECT_EQ(fs::last_write_time(sweep() / "runs" / (made.runs[1].id + ".json")), before);
  EXPECT_TRUE(fs::is_empty(sweep() / "claims"));
  EXPECT_TRUE(fs::is_empty(sweep() / "work"));
}

// Whoever comes first does a run: together the workers do each once.
TEST_F(SweepTest, TwoAtOnceShareTheWork) {
  const SweepPlan made =
      plan(head_ + "[vary]\n\"material.z_stretch\" = { from = 0.3, to = 0.9, count = 10 }\n");
  SweepDone one, other;
  std::thread beside([&] { other = run_sweep(sweep(), made, {}, RunContext()); });
  one = run_sweep(sweep(), made, {}, context_);
  beside.join();
  EXPECT_EQ(one.done + other.done, 10);
  EXPECT_EQ(one.done + one.before + one.elsewhere, 10);
  EXPECT_EQ(one.failed + other.failed, 0);
  // What was left while the other was at it is there now.
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).before, 10);
}

TEST_F(SweepTest, ShardsAreAllTheRuns) {
  const SweepPlan made =
      plan(head_ + "[vary]\n\"material.z_stretch\" = { from = 0.3, to = 0.9, count = 7 }\n");
  int done = 0;
  for (int shard = 1; shard <= 3; ++shard) {
    const SweepDone part = run_sweep(sweep(), made, {{shard, 3}, "", false}, context_);
    EXPECT_EQ(part.before, 0);
    done += part.done;
  }
  EXPECT_EQ(done, 7);
}

TEST_F(SweepTest, ARunThatFailsIsAnOutcomeWithItsSentence) {
  const SweepPlan made = plan(head_ + "[vary]\n\"film.margin_mm\" = [10, 200]\n");
  const SweepDone done = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(done.done, 1);
  EXPECT_EQ(done.failed, 1);
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).before, 2);
  EXPECT_EQ(run_sweep(sweep(), made, {{}, "", true}, context_).failed, 1);
  const SweepTable table = make_table(sweep(), made);
  EXPECT_EQ(table.rows[1].state, RunState::kFailed);
  EXPECT_TRUE(contains(table.rows[1].error, "film")) << table.rows[1].error;
  EXPECT_TRUE(contains(table_csv(table, made), table.rows[1].run->id + ",failed"));
}

TEST_F(SweepTest, OrientsManyModels) {
  const SweepPlan made = plan(
      "[sweep]\ncommand = \"orient\"\nmodels = [\"tetrahedron.obj\"]\nquality = \"draft\"\n"
      "[set]\n\"film.elements\" = 2000\n\"dip.step_mm\" = 1\n\"dip.air_cells\" = 0\n"
      "[vary]\n\"object.size_mm\" = [80]\n");
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).done, 1);
  const Json table = Json::parse(table_json(make_table(sweep(), made), made));
  for (const Json& run : table["runs"]) EXPECT_GT(run["figures"]["best.covered_share"], 0.0);
}

TEST_F(SweepTest, CancelledItLeavesNothingHalf) {
  const SweepPlan made =
      plan(head_ + "[vary]\n\"material.z_stretch\" = { from = 0.3, to = 0.9, count = 9 }\n");
  for (const int checks : {5, 50, 500}) {
    const RunContext context;
    context.cancel_at_check(checks);
    try {
      run_sweep(sweep(), made, {}, context.with_threads(1));
    } catch (const Cancelled&) {
    }
    EXPECT_TRUE(fs::is_empty(sweep() / "work"));
    for (const auto& entry : fs::directory_iterator(sweep() / "runs"))
      EXPECT_TRUE(read_outcome(sweep(), entry.path().stem().string())->error.empty());
  }
  run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).before, 9);
}

TEST_F(SweepTest, TheTableHasALineForEveryRun) {
  const SweepPlan made = plan(head_ + "[vary]\n\"dip.depth_mm\" = [3, 6, 9, 12]\n");
  run_sweep(sweep(), made, {{1, 2}, "", false}, context_);
  const SweepTable table = make_table(sweep(), made);
  const std::string csv = table_csv(table, made);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
  EXPECT_EQ(table.rows[0].state, RunState::kDone);
  EXPECT_EQ(table.rows[1].state, RunState::kMissing);
  const Json json = Json::parse(table_json(table, made));
  EXPECT_EQ(json["runs"].size(), 4U);
  // Deeper covers more.
  const auto covered = [&](int run) {
    return json["runs"][std::size_t(run)]["figures"]["coverage.covered_mm2"].get<double>();
  };
  EXPECT_GT(covered(2), covered(0));
  EXPECT_TRUE(contains(response_svg(table, made), "dip.depth_mm"));
}

TEST(SweepScripts, PackShortRunsSoThatTasksLast) {
  EXPECT_EQ(tasks_for(1, 1), 1);
  EXPECT_EQ(tasks_for(500, 0.001), 1);     // half a second altogether
  EXPECT_EQ(tasks_for(500, 0.3), 8);       // two and a half minutes: shared among a few
  EXPECT_EQ(tasks_for(500, 60), 250);      // two minutes each
  EXPECT_EQ(tasks_for(100000, 60), 1000);  // no more than an array may have
  EXPECT_EQ(tasks_for(5, 10000), 5);       // no more than there are
}

}  // namespace
}  // namespace hydrodip
