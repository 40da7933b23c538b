#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "contains.h"
#include "image/files.h"
#include "job/jobs.h"
#include "no_locks.h"
#include "refusal.h"
#include "settings/params.h"
#include "sweep/scripts.h"
#include "sweep/sweep_inputs.h"
#include "sweep/sweep_jobs.h"
#include "sweep/sweep_manifest.h"
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
    return read_sweep(folder_ / "sweep.toml", sweep(), context_);
  }
  std::string why(const std::string& toml) {
    return refusal([&] { plan(toml); });
  }
  fs::path sweep() {
    fs::create_directories(folder_ / "s");
    return folder_ / "s";
  }

  const TemporaryFolder folder_;
  const std::string any_depth_ =
      "[sweep]\nmodels = [\"tetrahedron.obj\"]\nquality = \"draft\"\n"
      "[set]\n\"film.elements\" = 300\n\"dip.step_mm\" = 3\n\"dip.air_cells\" = 0\n";
  const std::string head_ = any_depth_ + "\"dip.depth_mm\" = 9\n";
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

std::vector<std::string> values_of(const SweepPlan& plan, const std::string& name) {
  std::vector<std::string> values;
  for (const SweepRun& run : plan.runs) values.push_back(value_of(run, name));
  return values;
}

TEST_F(SweepTest, WholeNumbersOfARangeAreTheNearestAndOnceEach) {
  const std::string one = "[sweep]\nmodels = [\"tetrahedron.obj\"]\n[vary]\n\"film.elements\" = ";
  EXPECT_EQ(values_of(plan(one + "{ from = 300, to = 305, count = 4 }\n"), "film.elements"),
            (std::vector<std::string>{"300", "302", "303", "305"}));
  const SweepPlan few = plan(one + "{ from = 300, to = 302, count = 9 }\n");
  EXPECT_EQ(values_of(few, "film.elements"), (std::vector<std::string>{"300", "301", "302"}));
  EXPECT_EQ(few.same, 0U);
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

TEST_F(SweepTest, AxesOfALatinHypercubeAreNotAlikeAndItsSeedMatters) {
  const auto latin = [&](int seed) {
    return plan("[sweep]\nmethod = \"latin\"\nruns = 40\nseed = " + std::to_string(seed) +
                "\nmodels = [\"tetrahedron.obj\"]\n"
                "[vary]\n\"material.z_stretch\" = { from = 0.2, to = 1 }\n"
                "\"material.tear_stretch\" = { from = 1.2, to = 2 }\n"
                "\"material.poisson\" = [0, 0.1, 0.2, 0.3]\n");
  };
  const SweepPlan first = latin(1);
  int alike = 0;
  std::map<std::string, int> poisson;
  for (const SweepRun& run : first.runs) {
    const double z = std::stod(value_of(run, "material.z_stretch")),
                 tear = std::stod(value_of(run, "material.tear_stretch"));
    alike += int(40 * (z - 0.2) / 0.8) == int(40 * (tear - 1.2) / 0.8) ? 1 : 0;
    ++poisson[value_of(run, "material.poisson")];
  }
  EXPECT_LT(alike, 10);
  EXPECT_EQ(poisson,
            (std::map<std::string, int>{{"0", 10}, {"0.1", 10}, {"0.2", 10}, {"0.3", 10}}));
  EXPECT_EQ(ids(latin(1)), ids(first));
  EXPECT_NE(ids(latin(2)), ids(first));
}

// What is said of all runs, of some and of one.
TEST_F(SweepTest, WhatARunSaysStandsInPlaceOfWhatHoldsForAll) {
  write_file(folder_ / "other.obj", std::string("v 0 0 0\nv 30 -20 14\nv 20 20 14\nv -20 0 14\n"
                                                "f 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n"));
  const SweepPlan list = plan(head_ +
                              "[[run]]\n\"dip.depth_mm\" = 5\n[[run]]\nmodel = \"other.obj\"\n"
                              "[[run]]\n\"material.poisson\" = 0.1\n");
  ASSERT_EQ(list.runs.size(), 3U);
  EXPECT_EQ(value_of(list.runs[0], "dip.depth_mm"), "5");
  EXPECT_EQ(value_of(list.runs[1], "dip.depth_mm"), "9");
  EXPECT_EQ(value_of(list.runs[2], "material.poisson"), "0.1");
  EXPECT_EQ(sweep_config(list, list.runs[0], sweep()).design.trajectory.depth_mm, 5);
  EXPECT_EQ(fs::path(list.runs[1].model).filename(), "other.obj");
  EXPECT_EQ(sweep_config(list, list.runs[1], sweep()).model.filename(), "other.obj");
  EXPECT_EQ(sweep_config(list, list.runs[2], sweep()).model.filename(), "tetrahedron.obj");
  EXPECT_EQ(list.varied, (std::vector<std::string>{"model", "dip.depth_mm", "material.poisson"}));
  EXPECT_TRUE(contains(table_csv(make_table(sweep(), list), list),
                       "id,state,model,dip.depth_mm,material.poisson,verdict"));
}

TEST_F(SweepTest, ARunHasTheSweepsQualityAndLooksForNoOtherPose) {
  for (const auto& [quality, elements] :
       {std::pair("normal", 40000), {"draft", kDraftElements}, {"fine", 160000}}) {
    const SweepPlan made = plan("[sweep]\nmodels = [\"tetrahedron.obj\"]\nquality = \"" +
                                std::string(quality) + "\"\n");
    ASSERT_EQ(made.runs.size(), 1U);
    const JobConfig config = sweep_config(made, made.runs[0], sweep());
    EXPECT_EQ(config.design.film.elements, elements) << quality;
    EXPECT_FALSE(config.plan.suggest);
  }
}

TEST_F(SweepTest, AWayMayStandInTheSweepItself) {
  const SweepPlan made = plan(any_depth_ + "path = \"0, 0, 0, 0, 0, 0; 9, 1, 0, 0, 0, 0\"\n");
  const std::vector<Keyframe> path =
      sweep_config(made, made.runs[0], sweep()).design.trajectory.path;
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[1].shift_x_mm, 1);
}

TEST_F(SweepTest, ARunThatThereIsNotIsRefused) {
  const SweepPlan made = plan(head_);
  EXPECT_TRUE(contains(refusal([&] {
                         run_sweep(sweep(), made, {{}, "0123456789abcdef", false, ""}, context_);
                       }),
                       "no run '0123456789abcdef'"));
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

// A square with a picture on it, beside the other model.
class SweepInputsTest : public SweepTest {
 protected:
  void SetUp() override {
    SweepTest::SetUp();
    for (const char* folder : {"red", "blue"}) {
      fs::create_directories(folder_ / folder);
      write_file(folder_ / folder / "box.obj",
                 std::string("mtllib box.mtl\nv 0 0 0\nv 20 -20 14\nv 20 20 14\nv -20 0 14\n"
                             "vt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
                             "f 1/1 3/2 2/3\nf 1/1 4/2 3/3\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\n"));
      write_file(folder_ / folder / "box.mtl", std::string("newmtl m\nmap_Kd box.png\n"));
      paint(folder, folder == std::string("red") ? 200 : 20);
    }
  }

  void paint(const std::string& folder, std::uint8_t red) {
    Image picture(2, 2);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
      picture.rgba[i] = red;
      picture.rgba[i + 3] = 255;
    }
    const std::vector<std::uint8_t> png = encode_png(picture);
    write_file(folder_ / folder / "box.png", png.data(), png.size());
  }

  const std::string values_ =
      "[set]\n\"film.elements\" = 300\n\"dip.step_mm\" = 3\n\"dip.depth_mm\" = 9\n"
      "\"dip.air_cells\" = 0\n";
  const std::string boxes_ =
      "[sweep]\nmodels = [\"red/box.obj\", \"blue/box.obj\"]\nquality = \"draft\"\n" + values_;
};

// The model's bytes are the same; what belongs to it is not.
TEST_F(SweepInputsTest, AnotherPictureIsAnotherRunAndTheSameIsSaid) {
  EXPECT_EQ(plan(boxes_).runs.size(), 2U);
  EXPECT_EQ(plan(boxes_).same, 0U);
  paint("blue", 200);
  const SweepPlan twins = plan(boxes_);
  EXPECT_EQ(twins.runs.size(), 1U);
  EXPECT_EQ(twins.same, 1U);
}

TEST_F(SweepInputsTest, WhatAValueNamesIsPartOfTheRun) {
  const std::string toml = "[sweep]\nmodels = [\"red/box.obj\"]\nquality = \"draft\"\n" + values_ +
                           "\"object.texture\" = \"blue/box.png\"\n";
  const auto first = ids(plan(toml));
  EXPECT_EQ(ids(plan(toml)), first);
  paint("blue", 99);
  EXPECT_NE(ids(plan(toml)), first);
  // And so is what the job names, its ways included.
  write_file(folder_ / "way.csv",
             std::string("lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg\n"
                         "0,0,0,0,0,0\n9,0,0,0,0,0\n"));
  write_file(folder_ / "job.toml", std::string("path = \"way.csv\"\n"));
  const std::string job = "[sweep]\nmodels = [\"red/box.obj\"]\njob = \"job.toml\"\n";
  const auto before = ids(plan(job));
  write_file(folder_ / "way.csv",
             std::string("lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg\n"
                         "0,0,0,0,0,0\n9,1,0,0,0,0\n"));
  EXPECT_NE(ids(plan(job)), before);
}

TEST_F(SweepInputsTest, APrintIsPrinted) {
  const auto made_by = [&](const std::string& command, const std::string& quality) {
    return plan("[sweep]\nmodels = [\"red/box.obj\"]\ncommand = \"" + command + "\"\nquality = \"" +
                quality + "\"\n" + values_ + "\"print.dpi\" = 72\n");
  };
  const SweepPlan made = made_by("print", "draft");
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).done, 1);
  EXPECT_EQ(Json::parse(read_outcome(sweep(), made.runs[0].id)->report)["command"], "print");
  // Of a simulation and another quality nothing is taken for it.
  EXPECT_NE(ids(made_by("simulate", "draft")), ids(made));
  EXPECT_NE(ids(made_by("print", "fine")), ids(made));
}

// Of a job: its values, the pictures on its model, what its dips are corrected by.
TEST_F(SweepInputsTest, WhatAJobNamesIsPartOfTheRun) {
  const std::string job = "[sweep]\njob = \"job.toml\"\nquality = \"draft\"\n";
  const auto ids_with = [&](const std::string& toml) {
    write_file(folder_ / "job.toml", "[object]\nfile = \"red/box.obj\"\n" + toml);
    return ids(plan(job));
  };
  const std::string art = "[[artwork]]\nimage = \"blue/box.png\"\n",
                    dips = "[[dip]]\n[[dip]]\ncorrection = \"c.json\"\n";
  write_file(folder_ / "c.json", std::string("one"));
  const auto shallow = ids_with("[dip]\ndepth_mm = 5\n"), pictured = ids_with(art),
             corrected = ids_with(dips);
  EXPECT_NE(ids_with("[dip]\ndepth_mm = 6\n"), shallow);
  EXPECT_EQ(ids_with("[dip]\ndepth_mm = 5\n"), shallow);
  paint("blue", 99);
  EXPECT_NE(ids_with(art), pictured);
  write_file(folder_ / "c.json", std::string("other"));
  EXPECT_NE(ids_with(dips), corrected);
}

TEST_F(SweepTest, AFileIsWhatIsInItNow) {
  FileHashes hashes;
  write_file(folder_ / "a", std::string("one"));
  const std::string one = hashes.of(folder_ / "a");
  EXPECT_EQ(one, sha256_hex("one"));
  EXPECT_EQ(hashes.of(folder_ / "a"), one);
  write_file(folder_ / "a", std::string("other"));
  EXPECT_EQ(hashes.of(folder_ / "a"), sha256_hex("other"));
  EXPECT_EQ(hashes.of(folder_ / "nowhere"), "");
}

TEST_F(SweepTest, WhatIsOnOrOffMayBeTrueOrFalse) {
  const SweepPlan made = plan(any_depth_ +
                              "\"preview.pictures\" = false\n"
                              "[vary]\n\"ink.compensation\" = [true, false]\n");
  ASSERT_EQ(made.runs.size(), 2U);
  EXPECT_EQ(value_of(made.runs[0], "ink.compensation"), "on");
  EXPECT_EQ(value_of(made.runs[1], "ink.compensation"), "off");
  EXPECT_TRUE(
      contains(why(any_depth_ + "[vary]\n\"dip.depth_mm\" = [true]\n"), "true is no value"));
}

// Wherever the program is started: `sweep run` may be, on another machine, in the sweep's folder.
TEST_F(SweepInputsTest, FileNamesAreTakenFromTheSweepsFile) {
  const SweepPlan made =
      plan("[sweep]\nmodels = [\"red/box.obj\"]\nquality = \"draft\"\n" + values_ +
           "[vary]\n\"object.texture\" = [\"red/box.png\", \"blue/box.png\"]\n");
  ASSERT_EQ(made.runs.size(), 2U);
  EXPECT_EQ(fs::weakly_canonical(sweep() / value_of(made.runs[1], "object.texture")),
            fs::weakly_canonical(folder_ / "blue/box.png"));
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).done, 2);
  EXPECT_TRUE(contains(why("[sweep]\nmodels = [\"red/box.obj\"]\n[set]\n\"object.texture\" = "
                           "\"green/box.png\"\n"),
                       "there is no file"));
}

// No result of other bytes under an id that was planned for these.
TEST_F(SweepInputsTest, WhatChangedSinceItWasPlannedIsNotDone) {
  const SweepPlan made = plan(boxes_);
  paint("blue", 77);
  const SweepDone done = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(done.done, 1);
  EXPECT_EQ(done.changed, 1);
  EXPECT_TRUE(contains(done.what_changed, "box.png has changed since the sweep was planned"))
      << done.what_changed;
  EXPECT_FALSE(read_outcome(sweep(), made.runs[1].id));
  // Planned anew, the other is not done again.
  const SweepDone anew = run_sweep(sweep(), plan(boxes_), {}, context_);
  EXPECT_EQ(anew.before, 1);
  EXPECT_EQ(anew.done, 1);
  // Nor of other values.
  SweepPlan edited = plan(boxes_);
  edited.runs[0].values.emplace_back("dip.depth_mm", "5");
  fs::remove_all(sweep() / "runs");
  EXPECT_EQ(run_sweep(sweep(), edited, {}, context_).changed, 1);
}

// Not even to say what is wrong with it now.
TEST_F(SweepInputsTest, WhatIsNoModelOrJobAnyMoreIsNotARunsFailure) {
  const SweepPlan made = plan(boxes_);
  write_file(folder_ / "red/box.obj", std::string("no model\n"));
  const SweepDone done = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(done.changed, 1);
  EXPECT_EQ(done.failed, 0);
  write_file(folder_ / "job.toml", std::string("[object]\nfile = \"blue/box.obj\"\n"));
  const SweepPlan job = plan("[sweep]\njob = \"job.toml\"\nquality = \"draft\"\n" + values_);
  write_file(folder_ / "job.toml", std::string("[object\n"));
  EXPECT_TRUE(contains(run_sweep(sweep(), job, {}, context_).what_changed,
                       "job.toml has changed since the sweep was planned"));
}

// While it ran: then what it says that it has read is not what was planned.
TEST_F(SweepInputsTest, WhatAReportHasReadIsWhatWasPlanned) {
  const SweepPlan made = plan(boxes_);
  const fs::path model = fs::weakly_canonical(folder_ / "red/box.obj");
  const auto reads = [&](const fs::path& file, const std::string& role, const std::string& hash) {
    const Json report = {{"inputs", {{{"path", file.string()}, {"role", role}, {"sha256", hash}}}}};
    return refusal([&] { require_as_planned(made, report.dump(), sweep()); });
  };
  EXPECT_EQ(reads(model, "model", made.inputs.at(made.runs[0].model)), "");
  EXPECT_TRUE(contains(reads(model, "model", "another"), "box.obj has changed"));
  EXPECT_TRUE(contains(reads(folder_ / "new.png", "texture", "any"), "new.png has changed"));
  EXPECT_EQ(reads("/usr/share/a.ttf", "font", "any"), "");  // this machine's
}

// Known when all is done: no result, and no files that would be taken for one.
TEST_F(SweepInputsTest, WhatWasReadBesideThePlanLeavesNothing) {
  std::string all = boxes_;
  SweepPlan made = plan(all.replace(all.find("quality"), 0, "keep = \"all\"\n"));
  made.runs.resize(1);
  made.model_files[made.runs[0].model].resize(1);
  std::erase_if(made.inputs, [](const auto& file) { return !file.first.ends_with(".obj"); });
  FileHashes hashes;
  note_inputs(made, made.runs[0], sweep(), hashes, context_);
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).changed, 1);
  EXPECT_FALSE(read_outcome(sweep(), made.runs[0].id));
  EXPECT_FALSE(fs::exists(sweep() / "files" / made.runs[0].id));
}

// A picture that was missing when the sweep was planned.
TEST_F(SweepInputsTest, WhatAppearedSinceIsAChangeToo) {
  fs::rename(folder_ / "blue/box.png", folder_ / "away.png");
  const SweepPlan made = plan(boxes_);
  fs::rename(folder_ / "away.png", folder_ / "blue/box.png");
  const SweepDone done = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(done.done, 1);
  EXPECT_EQ(done.changed, 1);
}

TEST_F(SweepInputsTest, FilesThatAreWantedLaterAreMadeThen) {
  const SweepPlan made = plan(head_);
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).done, 1);
  std::string all = head_;
  const SweepPlan kept = plan(all.replace(all.find("quality"), 0, "keep = \"all\"\n"));
  EXPECT_EQ(ids(kept), ids(made));
  EXPECT_EQ(run_sweep(sweep(), kept, {}, context_).done, 1);
  EXPECT_TRUE(fs::exists(sweep() / "files" / made.runs[0].id / "film.ply"));
  EXPECT_EQ(run_sweep(sweep(), kept, {}, context_).before, 1);
}

// 0.50 and 0.5 are one value, however they are written.
TEST_F(SweepTest, AValueIsTheSameHoweverItIsWritten) {
  const SweepPlan made =
      plan(head_ + "[vary]\n\"material.z_stretch\" = [0.5, \"0.50\", \"+.5\"]\n");
  EXPECT_EQ(made.runs.size(), 1U);
  EXPECT_EQ(made.same, 2U);
}

TEST_F(SweepTest, RefusesWhatItWouldPassOver) {
  const std::string one = "[sweep]\nmodels = [\"tetrahedron.obj\"]\n";
  EXPECT_TRUE(contains(why(one + "[vary]\n\"object.file\" = [\"tetrahedron.obj\"]\n"),
                       "both name the model"));
  EXPECT_TRUE(contains(why(one + "[[run]]\n\"dip.depth_mm\" = 3\n[vary]\n\"dip.step_mm\" = [1]\n"),
                       "[vary]"));
  EXPECT_TRUE(contains(why(one + "method = \"grid\"\n[[run]]\n\"dip.depth_mm\" = 3\n"), "[[run]]"));
  EXPECT_TRUE(contains(why(one + "runs = 7\n[vary]\n\"dip.step_mm\" = [1]\n"), "sweep.runs"));
  EXPECT_TRUE(contains(why(one + "seed = 7\n[vary]\n\"dip.step_mm\" = [1]\n"), "sweep.seed"));
  const auto range = [&](const std::string& method, const std::string& rest) {
    return why(one + method + "[vary]\n\"material.z_stretch\" = { from = 0.3, to = 0.9" + rest +
               " }\n");
  };
  EXPECT_TRUE(contains(range("method = \"latin\"\n", ", count = 5"), "leave out count"));
  EXPECT_TRUE(contains(range("", ", count = 4294967298"), "4294967298"));
  EXPECT_TRUE(contains(range("", ", count = 1"), "from 2"));
  EXPECT_TRUE(contains(range("", ", count = 3, log = \"yes\""), "true or false"));
  EXPECT_TRUE(contains(why(one + "[vary]\n\"material.poisson\" = { from = 0, to = 0.3, count = 3, "
                                 "log = true }\n"),
                       "equal factors need from and to above 0"));
  EXPECT_TRUE(contains(why(one + "[vary]\n\"dip.step_mm\" = [nan]\n"), "nan"));
  for (const char* vary :
       {"[vary]\n\"dip.depth_mm\" = [3, 6]\n", "[vary.dip]\ndepth_mm = [3, 6]\n"})
    EXPECT_TRUE(contains(why(head_ + vary),
                         "dip.depth_mm stands under [set], which holds for all runs, and under "
                         "[vary]"));
  EXPECT_TRUE(contains(why(head_ + "[set.dip]\ndepth_mm = 3\n"), "dip.depth_mm stands twice"));
}

TEST_F(SweepTest, PlanningCanBeCancelled) {
  write_file(folder_ / "sweep.toml",
             head_ + "[vary]\n\"material.z_stretch\" = { from = 0.3, to = 0.9, count = 100 }\n");
  const RunContext context;
  context.cancel_at_check(50);
  EXPECT_THROW(read_sweep(folder_ / "sweep.toml", sweep(), context), Cancelled);
}

// A power cut in mid-write, or another run's result under this name.
TEST_F(SweepTest, ADamagedOutcomeIsDoneAgain) {
  const SweepPlan made = plan(head_ + "[vary]\n\"material.z_stretch\" = [0.4, 0.5, 0.6]\n");
  run_sweep(sweep(), made, {}, context_);
  const auto file = [&](std::size_t run) {
    return sweep() / "runs" / (made.runs[run].id + ".json");
  };
  write_file(file(0), std::string("{\"id\":"));
  fs::copy_file(file(2), file(1), fs::copy_options::overwrite_existing);
  const SweepTable table = make_table(sweep(), made);
  EXPECT_EQ(table.rows[0].state, RunState::kMissing);
  EXPECT_EQ(table.rows[1].state, RunState::kMissing);
  EXPECT_EQ(table.rows[2].state, RunState::kDone);
  const SweepDone done = run_sweep(sweep(), made, {{}, "", true}, context_);
  EXPECT_EQ(done.done, 2);
  EXPECT_EQ(done.before, 1);
}

TEST_F(SweepTest, APlanSaysWhetherItsFirstRunWorksAndHowManyTasksThereAre) {
  const auto planned = [&](const std::string& vary) {
    write_file(folder_ / "sweep.toml", head_ + vary);
    return sweep_plan_job({folder_ / "sweep.toml", sweep(), true, 7, "1.0"}, context_);
  };
  const JobResult good = planned("[vary]\n\"film.margin_mm\" = [10, 12]\n");
  EXPECT_EQ(Json::parse(good.json)["tasks"], 2);  // no more than there are runs
  EXPECT_GT(Json::parse(good.json)["seconds_each"], 0.0);
  EXPECT_TRUE(contains(good.text, "2 runs, about ")) << good.text;
  const auto mode = fs::status(sweep() / "slurm.sh").permissions();
  EXPECT_NE(mode & fs::perms::owner_exec, fs::perms::none);
  const JobResult bad = planned("[vary]\n\"film.margin_mm\" = [200, 12]\n");
  EXPECT_TRUE(Json::parse(bad.json)["seconds_each"].is_null());
  EXPECT_TRUE(contains(bad.text, "the first run failed: ")) << bad.text;
}

TEST_F(SweepTest, TenOfManyFailuresAreTold) {
  write_file(folder_ / "sweep.toml",
             head_ + "[vary]\n\"film.margin_mm\" = { from = 200, to = 211, count = 12 }\n");
  sweep_plan_job({folder_ / "sweep.toml", sweep(), false, 1, "1.0"}, context_);
  run_sweep(sweep(), read_manifest(sweep()), {}, context_);
  const std::string told = sweep_collect_job(sweep(), context_).text;
  EXPECT_TRUE(contains(told, "12 runs: 0 done, 12 failed, 0 missing")) << told;
  EXPECT_TRUE(contains(told, "and 2 more, see table.csv")) << told;
}

TEST_F(SweepTest, AChangedInputIsNoEnd) {
  write_file(folder_ / "sweep.toml", head_ + "[vary]\n\"film.margin_mm\" = [10, 12]\n");
  sweep_plan_job({folder_ / "sweep.toml", sweep(), false, 1, "1.0"}, context_);
  std::ofstream(folder_ / "tetrahedron.obj", std::ios::app) << "# changed\n";
  EXPECT_TRUE(contains(refusal([&] { sweep_run_job(sweep(), {}, context_); }),
                       "0 done, 0 failed, 2 not done for that"));
}

// What people have changed in a script, or put beside the results, stays theirs.
TEST_F(SweepTest, KeepsWhatPeopleWrote) {
  write_file(folder_ / "sweep.toml", head_ + "[vary]\n\"material.z_stretch\" = [0.4, 0.5]\n");
  const SweepPlanRequest request{folder_ / "sweep.toml", sweep(), false, 1};
  sweep_plan_job(request, context_);
  std::ofstream(sweep() / "slurm.sh", std::ios::app) << "# my partition\n";
  write_file(sweep() / "parallel.sh", std::string("# hydrodip, mine\n"));
  for (int time = 0; time < 2; ++time) {
    const JobResult again = sweep_plan_job(request, context_);
    EXPECT_TRUE(contains(again.text, "kept slurm.sh")) << again.text;
    const std::vector<std::uint8_t> kept = read_file(sweep() / "slurm.sh");
    EXPECT_TRUE(contains(std::string(kept.begin(), kept.end()), "my partition"));
    EXPECT_EQ(fs::file_size(sweep() / "parallel.sh"), 17U);
  }
  write_file(sweep() / "table.csv", std::string("mine\n"));
  EXPECT_TRUE(contains(refusal([&] { sweep_collect_job(sweep(), context_); }), "table.csv"));
  fs::remove(sweep() / "table.csv");
  run_sweep(sweep(), read_manifest(sweep()), {}, context_);
  sweep_collect_job(sweep(), context_);
  EXPECT_TRUE(fs::exists(sweep() / "response.svg"));
  // Without a varied number there is nothing to plot, and an earlier plot is of another sweep.
  write_file(folder_ / "sweep.toml", head_);
  sweep_plan_job(request, context_);
  sweep_collect_job(sweep(), context_);
  EXPECT_FALSE(fs::exists(sweep() / "response.svg"));
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
  EXPECT_TRUE(contains(why(head_ + "[vary]\n\"material.poisson\" = { from = 0, to = 0.3, count = "
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
  SweepPlan kept = made;
  kept.keep_files = true;
  write_file(sweep() / "sweep.json", manifest_json(kept));
  EXPECT_TRUE(read_manifest(sweep()).keep_files);
  std::string other = manifest_json(made);
  other.replace(other.find("\"hydrodip_sweep\": 2"), 19, "\"hydrodip_sweep\": 1");
  write_file(sweep() / "sweep.json", other);
  EXPECT_TRUE(contains(refusal([&] { read_manifest(sweep()); }), "made by another version"));
  write_file(sweep() / "sweep.json", std::string("{\"hydrodip_sweep\": 2}"));
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

TEST_F(SweepTest, RunsAreDoneWhereTheFileSystemHasNoLocks) {
  const SweepPlan made = plan(head_ + "[vary]\n\"film.margin_mm\" = [10, 12]\n");
  const NoLocks here;
  const SweepDone done = run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(done.done, 2);
  EXPECT_EQ(done.elsewhere, 0);
  ASSERT_EQ(context_.warnings().size(), 1U);
  EXPECT_TRUE(contains(context_.warnings()[0], "no locks"));
  EXPECT_TRUE(fs::is_empty(sweep() / "claims"));
}

// A newer program may come to other numbers, and an id says nothing of it.
TEST_F(SweepTest, WhatAnotherVersionDidIsToldAndDoneAgainIfWanted) {
  const SweepPlan made = plan(head_ + "[vary]\n\"film.margin_mm\" = [10, 12, 200]\n");
  write_file(sweep() / "sweep.json", manifest_json(made));
  const SweepWork older{{}, "", false, "1.0"};
  SweepWork newer{{}, "", false, "1.1"};
  run_sweep(sweep(), made, {{}, made.runs[0].id, false, "1.1"}, context_);
  EXPECT_TRUE(contains(sweep_run_job(sweep(), older, context_).text,
                       "1 by hydrodip 1.1; this is hydrodip 1.0, and --again"));
  EXPECT_EQ(run_sweep(sweep(), made, newer, context_).by_others,
            (std::map<std::string, int>{{"1.0", 2}}));
  EXPECT_TRUE(contains(sweep_run_job(sweep(), newer, context_).text,
                       "2 by hydrodip 1.0; this is hydrodip 1.1, and --again"));
  EXPECT_TRUE(
      contains(sweep_collect_job(sweep(), context_).text, "2 by hydrodip 1.0, 1 by hydrodip 1.1"));
  const Json table = Json::parse(table_json(make_table(sweep(), made), made));
  EXPECT_EQ(table["runs"][0]["version"], "1.1");
  EXPECT_EQ(table["runs"][1]["version"], "1.0");

  newer.again = true;
  const SweepDone again = run_sweep(sweep(), made, newer, context_);
  EXPECT_EQ(again.before, 1);
  EXPECT_EQ(again.done, 1);
  EXPECT_EQ(again.failed, 1);
  EXPECT_TRUE(run_sweep(sweep(), made, newer, context_).by_others.empty());
  EXPECT_FALSE(contains(sweep_collect_job(sweep(), context_).text, "version"));
}

// Those of before versions were noted have their number in the report.
TEST_F(SweepTest, AnOutcomeWithoutItsVersionHasItsReports) {
  const SweepPlan made = plan(head_);
  run_sweep(sweep(), made, {}, context_);
  const std::optional<SweepOutcome> outcome = read_outcome(sweep(), made.runs[0].id);
  EXPECT_EQ(outcome->version, Json::parse(outcome->report)["tool"]["version"]);
  EXPECT_FALSE(outcome->version.empty());
}

// Of a hundred thousand runs it takes minutes to read what came of them.
TEST_F(SweepTest, ReadingWhatCameOfItStopsWhenItIsCancelled) {
  const SweepPlan made = plan(head_);
  context_.cancel();
  const RunScope scope(context_);
  EXPECT_THROW(make_table(sweep(), made), Cancelled);
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
  for (const std::optional<double>& figure : table.rows[1].figures) EXPECT_FALSE(figure);
  EXPECT_EQ(table.rows[0].verdict,
            Json::parse(read_outcome(sweep(), made.runs[0].id)->report)["concern"]);
  const std::vector<std::uint8_t> outcome =
      read_file(sweep() / "runs" / (made.runs[1].id + ".json"));
  EXPECT_EQ(Json::parse(outcome)["exit_code"], 2);
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
  const Json poses = Json::parse(read_outcome(sweep(), made.runs[0].id)->report)["poses"];
  EXPECT_EQ(table["runs"][0]["figures"]["best.score"], poses[0]["score"]);
  EXPECT_GT(poses.size(), 1U);
}

TEST_F(SweepTest, CancelledItLeavesNothingHalf) {
  const SweepPlan made =
      plan(head_ + "[vary]\n\"material.z_stretch\" = { from = 0.3, to = 0.9, count = 9 }\n");
  for (const int checks : {5, 50, 500}) {
    const RunContext context;
    context.cancel_at_check(checks);
    try {
      run_sweep(sweep(), made, {}, context.with_threads(1));
    } catch (const Cancelled& why) {
      const auto files = std::distance(fs::directory_iterator(sweep() / "runs"), {});
      EXPECT_TRUE(contains(why.what(), fmt::format(" {} of 9 runs are done", files))) << why.what();
    }
    EXPECT_TRUE(fs::is_empty(sweep() / "work"));
    for (const auto& entry : fs::directory_iterator(sweep() / "runs"))
      EXPECT_TRUE(read_outcome(sweep(), entry.path().stem().string())->error.empty());
  }
  run_sweep(sweep(), made, {}, context_);
  EXPECT_EQ(run_sweep(sweep(), made, {}, context_).before, 9);
}

TEST_F(SweepTest, TheTableHasALineForEveryRun) {
  const SweepPlan made = plan(any_depth_ + "[vary]\n\"dip.depth_mm\" = [3, 6, 9, 12]\n");
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

// The sweep's folder may be seen under another name by whoever puts it together.
TEST_F(SweepTest, AResultNamesItsFilesFromTheSweepsFolder) {
  const SweepPlan made = plan(head_);
  run_sweep(sweep(), made, {}, context_);
  const Json report = Json::parse(read_outcome(sweep(), made.runs[0].id)->report);
  EXPECT_EQ(report["inputs"][0]["path"], "../tetrahedron.obj");
  EXPECT_FALSE(contains(report.dump(), folder_.path().string())) << report.dump();
}

// Rows as they come, one without a result.
class SweepPicture : public ::testing::Test {
 protected:
  SweepPicture() {
    plan_.varied = {"dip.depth_mm"};
    table_.figure_names = {"coverage.torn_mm2"};
    for (const char* depth : {"10", "5", "5", "20", "7"})
      plan_.runs.push_back({"", "", {{"dip.depth_mm", depth}}});
    const double torn[] = {5, 2, 6, 100, 0};
    for (std::size_t k = 0; k < plan_.runs.size(); ++k) {
      SweepRow& row = table_.rows.emplace_back();
      row.run = &plan_.runs[k];
      row.state = RunState::kDone;
      row.figures = {torn[k]};
    }
    table_.rows[3].state = RunState::kFailed;
    table_.rows[4].state = RunState::kMissing;
    table_.rows[4].figures = {std::nullopt};
  }
  SweepPlan plan_;
  SweepTable table_;
};

TEST_F(SweepPicture, DrawsMuchAboveLittleFromLeftToRight) {
  const std::string svg = response_svg(table_, plan_);
  // Depths 5 to 10 from x = 70 to 298, areas 2 to 6 from y = 178 up to 40.
  EXPECT_TRUE(contains(svg, "<circle cx=\"298.0\" cy=\"74.5\"")) << svg;
  EXPECT_TRUE(contains(svg, "<circle cx=\"70.0\" cy=\"178.0\"")) << svg;
  EXPECT_TRUE(contains(svg, "<circle cx=\"70.0\" cy=\"40.0\"")) << svg;
  EXPECT_TRUE(contains(svg, "<polyline points=\"70.0,109.0 298.0,74.5 \"/>")) << svg;
}

TEST_F(SweepPicture, HasNoneOfWhatIsTheSameEverywhereOrNoNumber) {
  for (SweepRow& row : table_.rows) row.figures = {3.0};
  EXPECT_EQ(response_svg(table_, plan_), "");
  for (std::size_t k = 0; k < 3; ++k) table_.rows[k].figures = {double(k)};
  plan_.runs[1].values = {{"dip.depth_mm", "auto"}};
  EXPECT_EQ(response_svg(table_, plan_), "");
}

TEST_F(SweepPicture, ATablesCellIsOneWhateverStandsInIt) {
  plan_.runs[0].values = {{"dip.depth_mm", "1,2"}};
  table_.rows[3].error = "\"a\", b";
  const std::string csv = table_csv(table_, plan_);
  EXPECT_TRUE(contains(csv, ",done,\"1,2\",")) << csv;
  EXPECT_TRUE(contains(csv, ",\"\"\"a\"\", b\"\n")) << csv;
}

TEST(SweepScripts, AFoldersNameIsOneWord) {
  EXPECT_TRUE(contains(slurm_script(2, "/a b/c"), "cd '/a b/c'\n")) << slurm_script(2, "/a b/c");
  EXPECT_TRUE(is_as_made(slurm_script(2, "/a b/c")));
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
