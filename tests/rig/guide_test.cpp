#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>

#include "base/error.h"
#include "contains.h"
#include "full_disk.h"
#include "guided.h"
#include "refusal.h"
#include "rig/run_record.h"

namespace hydrodip {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

class GuideTest : public ::testing::Test {
 protected:
  void SetUp() override {
    // Two builds may run the same test at a time.
    folder_ = fs::path(::testing::TempDir()) /
              ("rig_guide_" + std::to_string(::getpid()) +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write_report(Json::object());
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_report(const Json& parameters) const { write_rig_report(folder_, parameters); }

  RigJob job(const std::string& port) const {
    RigJob job = load_rig_job(folder_, {});
    job.config.stage.port = port;
    return job;
  }

  std::vector<Json> log(int run = 1) const {
    return read_log(folder_ / ("rig-" + std::to_string(run)));
  }

  static const Json* find(const std::vector<Json>& lines, const std::string& event) {
    for (const Json& line : lines)
      if (line["event"] == event) return &line;
    return nullptr;
  }

  fs::path folder_;
};

// Asked only where there is a camera; what the last photo said is in the log, and what to move is
// said.
TEST_F(GuideTest, AsksWhereTheFilmLiesAndKeepsIt) {
  GuidedBench guided;
  write_file(folder_ / "camera.json", std::string("{}"));
  const auto photo = [&](double x_mm, const char* hash) {
    write_file(folder_ / "registration.json", Json{{"shift_mm", {{"x", x_mm}, {"y", -0.5}}},
                                                   {"turn_deg", {{"value", 0.25}}},
                                                   {"swelling", {{"x", 1.02}, {"y", 1.01}}},
                                                   {"photo", {{"sha256", hash}}}}
                                                  .dump());
  };
  photo(9, "old");  // of an earlier dip
  int questions = 0;
  guided.person.on_ask = [&](const std::string& question) {
    if (question.find("where it lies") != std::string::npos && ++questions == 2) photo(1.5, "new");
  };
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(questions, 2);
  EXPECT_NE(guided.person.said.find("as it was"), std::string::npos);
  EXPECT_NE(guided.person.said.find("Move the frame by 1.50 mm to the left and 0.50 mm to the top, "
                                    "and turn it by 0.25 degrees clockwise."),
            std::string::npos)
      << guided.person.said;
  const auto lines = log();
  ASSERT_NE(find(lines, "registered"), nullptr);
  EXPECT_EQ((*find(lines, "registered"))["x_mm"], 1.5);
}

TEST_F(GuideTest, LeadsFromHomeToRetractAndLogsWhatWas) {
  GuidedBench guided;
  const RigJob job = this->job(guided.emulator->port());
  const JobResult result = rig_guide(job, guided.bench, guided.context);
  const double water_mm = 57.5;
  const Emulator& machine = *guided.emulator;
  // Lifted clear at the end; and on the way exactly as deep and as fast as the job says.
  EXPECT_NEAR(machine.position_mm(), water_mm - job.config.stage.clearance_mm, 0.001);
  EXPECT_NEAR(machine.measured_speed_mm_per_min(water_mm, water_mm + 29), 100, 1);
  const auto lines = log();
  EXPECT_NEAR((*find(lines, "soaked"))["seconds"].get<double>(), 70, 0.5);
  EXPECT_TRUE((*find(lines, "soaked"))["within"].get<bool>());
  EXPECT_NEAR((*find(lines, "activator"))["used_g"].get<double>(), 3.5, 1e-9);
  EXPECT_GE((*find(lines, "activator worked"))["seconds"].get<double>(), 30);
  EXPECT_EQ(lines.back()["event"], "end");
  EXPECT_EQ(lines.back()["outcome"], "done");
  for (const Json& line : lines)
    if (line["event"] == "moved" && line["phase"] == "dip") {
      EXPECT_NEAR(line["position_mm"].get<double>(), water_mm + 29.5, 0.0006);
      EXPECT_LT(std::abs(line["speed_error_percent"].get<double>()), 1);
    }
  for (const char* file : {"log.jsonl", "trace.csv", "trace.svg", "report.html"})
    EXPECT_TRUE(fs::exists(result.folder / file)) << file;
  EXPECT_FALSE(last_broken_run(job).name.size());
}

TEST_F(GuideTest, DoesWithoutAStage) {
  GuidedBench guided;
  const double place_mm = guided.emulator->position_mm();
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(guided.emulator->position_mm(), place_mm);
  EXPECT_EQ(log().back()["outcome"], "done");
}

// The time that the depth takes at the job's speed: 29.5 mm at 100 mm/min.
TEST_F(GuideTest, TheHandDipTakesAsLongAsDepthAndSpeedSay) {
  GuidedBench guided;
  rig_guide(job(""), guided.bench, guided.context);
  const ScriptedOperator& person = guided.person;
  const double answer_s = 1, dwell_s = job("").config.process.dwell_s;
  const double down_s = person.asked_s("surface is clear") - person.asked_s("By hand") - answer_s;
  EXPECT_NEAR(down_s - dwell_s, 17.7, 0.5);
  EXPECT_NE(person.asked.at(0).second.find("film is ready"), std::string::npos);
  for (const auto& [time_s, line] : person.shown) {
    if (line.find("of 29.5 mm") == std::string::npos) continue;
    const double past_s = time_s - person.asked_s("By hand") - answer_s;
    EXPECT_NEAR(std::stod(line), past_s * 100 / 60, 0.06) << line;
  }
  EXPECT_NEAR((*find(log(), "dipped by hand"))["planned_s"].get<double>(), 17.7, 1e-9);
}

TEST_F(GuideTest, WaterOutsideItsRangeIsAskedAgainAndLogged) {
  GuidedBench guided;
  guided.person.temperatures = {"26.9", "30.1", "27", "30"};
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(guided.person.times_asked("too cold"), 1);
  EXPECT_EQ(guided.person.times_asked("too warm"), 1);
  std::vector<std::pair<double, bool>> measured;
  for (const Json& line : log())
    if (line["event"] == "water") measured.emplace_back(line["celsius"], line["within"]);
  const std::vector<std::pair<double, bool>> wanted = {
      {26.9, false}, {30.1, false}, {27, true}, {30, true}};
  EXPECT_EQ(measured, wanted);
}

TEST_F(GuideTest, WaterThatIsKeptOrMeasuredAfterIsAskedOnce) {
  GuidedBench guided;
  guided.person.keep_water = "keep";
  guided.person.temperatures = {"26.9", "26.9"};
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(guided.person.times_asked("Temperature"), 2);
  EXPECT_EQ(guided.person.times_asked("too cold"), 1);  // after the dip nothing can be mended
}

// From the moment that the spraying was done, as the clock has it, by hand and by stage.
TEST_F(GuideTest, TheActivatorWorksForItsThirtySeconds) {
  for (const bool by_stage : {false, true}) {
    GuidedBench guided;
    rig_guide(job(by_stage ? guided.emulator->port() : ""), guided.bench, guided.context);
    const ScriptedOperator& person = guided.person;
    const double sprayed_s = person.asked_s("Spray.") + 1;
    const double began_s = person.asked_s(by_stage ? "will now dip" : "By hand");
    EXPECT_GE(began_s - sprayed_s, 30);
    EXPECT_LT(began_s - sprayed_s, 30.5);
    EXPECT_NEAR((*find(log(by_stage ? 2 : 1), "activator worked"))["seconds"].get<double>(),
                began_s - sprayed_s, 0.01);
  }
}

// The wait begins anew with what was sprayed last.
TEST_F(GuideTest, TooLittleActivatorIsSprayedOnAndTooMuchIsNot) {
  GuidedBench guided;
  guided.person.guns_after = {"810.40", "808.90"};  // 2 g, then 3.5 g
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(guided.person.times_asked("Spray."), 2);
  EXPECT_GE(guided.person.asked_s("By hand") - guided.person.asked_s("Spray."), 33);
  GuidedBench second;
  second.person.guns_after = {"807.40"};  // 5 g
  rig_guide(job(""), second.bench, second.context);
  EXPECT_EQ(second.person.times_asked("Spray."), 1);
  EXPECT_NE(second.person.said.find("g too much"), std::string::npos);
  EXPECT_FALSE((*find(log(2), "activator"))["within"].get<bool>());
}

TEST_F(GuideTest, SoakingShorterOrLongerThanPlannedIsLogged) {
  const double soaked_s[] = {59, 61, 79, 81};
  for (int run = 0; run < 4; ++run) {
    GuidedBench guided;
    guided.person.soak_s = soaked_s[run];
    rig_guide(job(""), guided.bench, guided.context);
    const Json soaked = *find(log(run + 1), "soaked");
    EXPECT_NEAR(soaked["seconds"].get<double>(), soaked_s[run], 0.3);
    EXPECT_EQ(soaked["within"].get<bool>(), run == 1 || run == 2) << soaked;
  }
}

// Whatever the machine could do: stage.lowest_mm is the operator's.
TEST_F(GuideTest, NothingGoesLowerThanTheOperatorsLimit) {
  for (const StageDown down : {StageDown::kPlus, StageDown::kMinus}) {
    GuidedBench guided;
    RigJob job = this->job(guided.emulator->port());
    const bool plus = down == StageDown::kPlus;
    job.config.stage.down = down;
    job.config.stage.water_mm = plus ? 100 : 200;
    job.config.stage.lowest_mm = plus ? 129.4 : 170.6;  // the dip ends at 129.5 or 170.5
    guided.bench.yes_given = true;
    rig_stage({"home"}, nullptr, job.config.stage, guided.bench, guided.context);
    const auto dip = [&] {
      rig_stage({"dip"}, &job, job.config.stage, guided.bench, guided.context);
    };
    try {
      dip();
      ADD_FAILURE() << "it dipped";
    } catch (const StageError& error) {
      EXPECT_NE(std::string(error.what()).find("stage.lowest_mm"), std::string::npos);
    }
    job.config.stage.lowest_mm = plus ? 129.6 : 170.4;
    dip();
    EXPECT_NEAR(guided.emulator->position_mm(), plus ? 129.5 : 170.5, 0.001);
  }
}

// The object touches at 57.5 mm, so that the dip ends at 87: told before the film swims, not in mid
// dip.
TEST_F(GuideTest, ADipWithoutRoomIsRefusedBeforeTheWaterIsMeasured) {
  GuidedBench guided;
  RigJob job = this->job(guided.emulator->port());
  job.config.stage.lowest_mm = 86.9;
  EXPECT_THROW(rig_guide(job, guided.bench, guided.context), StageError);
  EXPECT_EQ(guided.person.times_asked("or here"), 3);
  EXPECT_EQ(guided.person.times_asked("Temperature"), 0);
  EXPECT_LT(guided.emulator->position_mm(), 57.6);
}

TEST_F(GuideTest, JoggingLowersWhicheverWayTheScaleRuns) {
  for (const StageDown down : {StageDown::kPlus, StageDown::kMinus}) {
    GuidedBench guided;
    StageOptions stage = this->job(guided.emulator->port()).config.stage;
    stage.down = down;
    guided.bench.yes_given = true;
    const auto jog = [&](double down_mm) {
      StageAction action{"jog"};
      action.jog_mm = down_mm;
      rig_stage(action, nullptr, stage, guided.bench, guided.context);
      return guided.emulator->position_mm();
    };
    const double sign = down == StageDown::kPlus ? 1 : -1;
    const double home_mm = jog(sign * 40);  // up the scale, whichever way that is
    EXPECT_NEAR(jog(5) - home_mm, 5 * sign, 0.001);
    EXPECT_NEAR(jog(-2) - home_mm, 3 * sign, 0.001);
  }
}

// The stage and the dip are fine: the person asked for too much, and is not even asked for a yes.
TEST_F(GuideTest, AJogBeyondTheTravelIsBadInputAndMovesNothing) {
  for (const StageDown down : {StageDown::kPlus, StageDown::kMinus}) {
    GuidedBench guided;
    StageOptions stage = this->job(guided.emulator->port()).config.stage;
    stage.down = down;
    guided.bench.yes_given = true;
    rig_stage({"home"}, nullptr, stage, guided.bench, guided.context);
    const double home_mm = guided.emulator->position_mm();
    const auto refusal_of = [&](double down_mm) {
      StageAction action{"jog"};
      action.jog_mm = down_mm;
      return refusal([&] { rig_stage(action, nullptr, stage, guided.bench, guided.context); });
    };
    for (const double beyond_mm : {2000.0, -2000.0}) {
      const std::string said = refusal_of(beyond_mm);
      EXPECT_TRUE(contains(said, "beyond the stage's travel")) << said;
      EXPECT_FALSE(contains(said, "object")) << said;
    }
    EXPECT_NEAR(guided.emulator->position_mm(), home_mm, 0.001);
    // Where the scale falls as the object goes down, home is at its lower end already.
    stage.lowest_mm = down == StageDown::kPlus ? 30 : 60;
    const double off_mm = down == StageDown::kPlus ? 40 : -50;
    EXPECT_TRUE(contains(refusal_of(off_mm), "stage.lowest_mm"));
    EXPECT_NEAR(guided.emulator->position_mm(), home_mm, 0.001);
  }
}

TEST_F(GuideTest, ProgramsLearnWhereTheStageStands) {
  GuidedBench guided;
  guided.bench.yes_given = true;
  const StageOptions stage = this->job(guided.emulator->port()).config.stage;
  const auto told = [&](const StageAction& action) {
    return nlohmann::json::parse(
        rig_stage(action, nullptr, stage, guided.bench, guided.context).json);
  };
  EXPECT_EQ(told({"status"})["homed"], false);
  StageAction jog{"jog"};
  jog.jog_mm = 5;
  const nlohmann::json before = told({"home"}), after = told(jog);
  EXPECT_EQ(before["homed"], true);
  EXPECT_EQ(after["port"], stage.port);
  EXPECT_EQ(after["moving"], false);
  const double way_mm = after["position_mm"].get<double>() - before["position_mm"].get<double>();
  EXPECT_NEAR(std::abs(way_mm), 5, 0.001);
  EXPECT_NEAR(after["position_mm"], guided.emulator->position_mm(), 0.001);
  const nlohmann::json ports = told({"find"})["ports"];
  ASSERT_EQ(ports.size(), 1U);
  EXPECT_EQ(ports[0]["port"], stage.port);
  EXPECT_EQ(ports[0]["is_stage"], true);
}

TEST_F(GuideTest, FortyRandomFaultSequencesLeaveNothingMoving) {
  int finished = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const Machine machine : {Machine::kZaber, Machine::kMarlin}) {
      std::string story;
      EXPECT_EQ(random_guided_faults(machine, seed, folder_ / "storm", story), "") << story;
      finished += story.ends_with("finished") ? 1 : 0;
    }
  EXPECT_GT(finished, 0);
  EXPECT_LT(finished, 40);
}

// A garbled command sent it back slowly, and the stop was believed before it stood.
TEST_F(GuideTest, AStopIsNotBelievedTooEarly) {
  std::string story;
  EXPECT_EQ(random_guided_faults(Machine::kMarlin, 1403, folder_ / "storm", story), "") << story;
  EXPECT_NE(story.find("stands still"), std::string::npos) << story;
}

TEST_F(GuideTest, ANoMovesNothing) {
  GuidedBench guided;
  guided.person.yes = "no";
  const double place_mm = guided.emulator->position_mm();
  EXPECT_THROW(rig_guide(job(guided.emulator->port()), guided.bench, guided.context), Cancelled);
  EXPECT_EQ(guided.emulator->position_mm(), place_mm);
  EXPECT_EQ(log().back()["outcome"], "cancelled");
}

TEST_F(GuideTest, AFaultInMidDipIsInTheLogAsItWas) {
  GuidedBench guided;
  guided.emulator->add({FaultKind::kStall, 140, 1});
  const RigJob job = this->job(guided.emulator->port());
  EXPECT_THROW(rig_guide(job, guided.bench, guided.context), StageError);
  const Json end = log().back();
  EXPECT_EQ(end["outcome"], "failed");
  EXPECT_EQ(end["step"], "dipped") << end;
  EXPECT_TRUE(end["stage_stands_still"].get<bool>());
  EXPECT_NEAR(end["stage_position_mm"].get<double>(), guided.emulator->position_mm(), 0.0006);
  EXPECT_NE(end["message"].get<std::string>().find("stalled"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "rig-1" / "trace.csv"));
}

// The disk is full from the second question on: nobody shall dip what is not kept.
TEST_F(GuideTest, StopsAtTheFirstLineThatCannotBeLogged) {
  GuidedBench guided;
  std::optional<FullDisk> disk;
  guided.person.on_ask = [&](const std::string& question) {
    if (question.starts_with("Temperature")) disk.emplace(1);
  };
  std::string why;
  try {
    rig_guide(job(""), guided.bench, guided.context);
  } catch (const InputError& error) {
    why = error.what();
  }
  disk.reset();
  EXPECT_TRUE(contains(why, "log.jsonl: 'water' cannot be written")) << why;
  EXPECT_EQ(guided.person.times_asked("Enter the moment it lies"), 0);
}

TEST_F(GuideTest, ARunThatCannotEvenBeginLeavesNoFolder) {
  GuidedBench guided;
  {
    const FullDisk disk(1);
    EXPECT_TRUE(contains(refusal([&] { rig_guide(job(""), guided.bench, guided.context); }),
                         "'start' cannot be written"));
  }
  EXPECT_FALSE(fs::exists(folder_ / "rig-1"));
}

TEST_F(GuideTest, AGunThatIsHeavierAfterwardsIsWeighedAgain) {
  GuidedBench guided;
  guided.person.guns_after = {"815", "809"};
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(guided.person.times_asked("heavier than before"), 1);
  const std::vector<Json> lines = log();
  const Json* activator = find(lines, "activator");
  ASSERT_NE(activator, nullptr);
  EXPECT_NEAR((*activator)["used_g"], 3.4, 1e-9);
}

TEST_F(GuideTest, ABrokenRunIsTakenUpWithoutRepeatingWhatIsStillThere) {
  GuidedBench first;
  first.clock.at(60, [&] { first.context.cancel(); });
  EXPECT_THROW(rig_guide(job(""), first.bench, first.context), Cancelled);
  EXPECT_EQ(last_broken_run(job("")).steps.front(), "film prepared");
  GuidedBench second;
  second.person.take_up = "yes";
  rig_guide(job(""), second.bench, second.context);
  EXPECT_EQ(second.person.said.find("Peel the backing"), std::string::npos);
  EXPECT_NE(second.person.said.find("LAY THE FILM"), std::string::npos);
  EXPECT_EQ(log(2).back()["outcome"], "done");
}

// Broken off again before anything new was done, it still has what the first one did.
TEST_F(GuideTest, ARunIsTakenUpTwice) {
  GuidedBench first;
  first.clock.at(60, [&] { first.context.cancel(); });
  EXPECT_THROW(rig_guide(job(""), first.bench, first.context), Cancelled);
  const std::vector<std::string> steps = last_broken_run(job("")).steps;
  GuidedBench second;
  second.person.take_up = "yes";
  second.clock.at(10, [&] { second.context.cancel(); });
  EXPECT_THROW(rig_guide(job(""), second.bench, second.context), Cancelled);
  const BrokenRun again = last_broken_run(job(""));
  EXPECT_EQ(again.name, "rig-2");
  ASSERT_FALSE(again.steps.empty());
  EXPECT_EQ(again.steps.front(), steps.front());
  GuidedBench third;
  third.person.take_up = "yes";
  rig_guide(job(""), third.bench, third.context);
  EXPECT_EQ(third.person.said.find("Peel the backing"), std::string::npos);
  EXPECT_EQ(log(3).back()["outcome"], "done");
}

// Whoever ends the program at the question has not said that film and object are gone, nor has who
// only moves the stage.
TEST_F(GuideTest, WhatIsPreparedOutlivesRunsThatDidNothingWithIt) {
  GuidedBench first;
  first.clock.at(60, [&] { first.context.cancel(); });
  EXPECT_THROW(rig_guide(job(""), first.bench, first.context), Cancelled);
  GuidedBench second;
  second.person.on_ask = [&](const std::string& question) {
    if (contains(question, "Keep that?")) throw Cancelled();
  };
  EXPECT_THROW(rig_guide(job(""), second.bench, second.context), Cancelled);
  EXPECT_EQ(last_broken_run(job("")).name, "rig-1");
  GuidedBench stage;
  stage.bench.yes_given = true;
  RigJob with_stage = job(stage.emulator->port());
  rig_stage({"approach"}, &with_stage, with_stage.config.stage, stage.bench, stage.context);
  EXPECT_EQ(last_broken_run(job("")).name, "rig-1");
  // Said to be gone, it is not offered again, however that run ended.
  GuidedBench third;
  third.person.take_up = "no";
  third.person.on_ask = [&](const std::string& question) {
    if (contains(question, "film is ready")) throw Cancelled();
  };
  EXPECT_THROW(rig_guide(job(""), third.bench, third.context), Cancelled);
  EXPECT_TRUE(last_broken_run(job("")).steps.empty());
}

TEST_F(GuideTest, FilmThatAStageDippedIsNotOfferedAgain) {
  GuidedBench first;
  first.clock.at(60, [&] { first.context.cancel(); });
  EXPECT_THROW(rig_guide(job(""), first.bench, first.context), Cancelled);
  GuidedBench stage;
  stage.bench.yes_given = true;
  RigJob with_stage = job(stage.emulator->port());
  with_stage.config.stage.water_mm = 100;
  rig_stage({"dip"}, &with_stage, with_stage.config.stage, stage.bench, stage.context);
  EXPECT_TRUE(last_broken_run(job("")).steps.empty());
}

TEST_F(GuideTest, WithoutActivatorNothingIsSprayedOrWaitedFor) {
  write_report({{"process.activator_g", {{"value", 0}}}});
  GuidedBench guided;
  rig_guide(job(""), guided.bench, guided.context);
  EXPECT_EQ(guided.person.said.find("ACTIVATOR"), std::string::npos) << guided.person.said;
  EXPECT_EQ(guided.person.times_asked("Spray"), 0);
  EXPECT_EQ(find(log(), "activator"), nullptr);
  EXPECT_EQ(log().back()["outcome"], "done");
}

TEST_F(GuideTest, TheActivatorFollowsTheFilmsArea) {
  const auto with_film = [&](double width, double height) {
    write_report({{"film.width_mm", {{"value", width}}}, {"film.height_mm", {{"value", height}}}});
    return activator_for(load_rig_job(folder_, {}).config).mass_g;
  };
  EXPECT_DOUBLE_EQ(with_film(215.9, 279.4), 3.5);
  EXPECT_DOUBLE_EQ(with_film(2 * 215.9, 279.4), 7);
}

TEST_F(GuideTest, SettingsOfTodayWinOverTheReport) {
  write_report({{"process.speed_mm_per_min", {{"value", 80}}},
                {"process.dwell_s", {{"value", 3}}},
                {"some.parameter_of_the_future", {{"value", 1}}}});
  SettingSources sources;
  sources.sets = {parse_set("process.dwell_s=7")};
  const RigJob job = load_rig_job(folder_, sources);
  EXPECT_EQ(job.config.process.speed_mm_per_min, 80);
  EXPECT_EQ(job.config.process.dwell_s, 7);
}

TEST_F(GuideTest, RefusesWhatIsNoJob) {
  for (const char* text : {"", "{", "[]", "{}", "{\"figures\": {\"depth_mm\": 5}}",
                           "{\"parameters\": {}, \"figures\": {\"depth_mm\": \"deep\"}}",
                           "{\"parameters\": {\"film.width_mm\": {\"value\": -3}}, \"figures\": "
                           "{\"depth_mm\": 5}}"}) {
    write_file(folder_ / "report.json", std::string(text));
    EXPECT_THROW(load_rig_job(folder_, {}), InputError) << text;
  }
  EXPECT_THROW(load_rig_job(folder_ / "nowhere", {}), InputError);
}

TEST_F(GuideTest, ThePlanLeadsThroughTheWaterAtConstantSpeed) {
  const RigJob job = this->job("");
  const auto plan = plan_dip(job);
  for (std::size_t i = 1; i < plan.size(); ++i)
    EXPECT_EQ(plan[i].from_height_mm, plan[i - 1].to_height_mm);
  EXPECT_GT(plan[1].from_height_mm, 0);
  EXPECT_EQ(plan[1].to_height_mm, -29.5);
  EXPECT_EQ(plan[1].mm_per_min, 100);
  EXPECT_EQ(plan.front().from_height_mm, plan.back().to_height_mm);
  // Constant speed begins where the approach ends: below the place where the object hangs clear.
  EXPECT_EQ(plan.front().from_height_mm, job.config.stage.clearance_mm);
  EXPECT_EQ(plan[1].from_height_mm,
            std::min(job.config.stage.approach_mm, job.config.stage.clearance_mm));
  EXPECT_LT(plan[1].from_height_mm, plan.front().from_height_mm);
  StageOptions minus;
  minus.down = StageDown::kMinus;
  EXPECT_EQ(stage_position_mm({}, 100, -29.5), 129.5);
  EXPECT_EQ(stage_position_mm(minus, 100, -29.5), 70.5);
}

TEST(Trace, MeasuresTheSpeedThatItWasMadeWith) {
  Trace trace;
  for (int i = 0; i <= 100; ++i) trace.push_back({"dip", 0.1 * i, 2.0 * 0.1 * i, 1.96 * 0.1 * i});
  const auto speed = check_speed(trace, "dip", 120);
  ASSERT_TRUE(speed);
  EXPECT_NEAR(speed->measured_mm_per_min, 117.6, 1e-9);
  EXPECT_NEAR(speed->error_percent(), -2, 1e-9);
  EXPECT_NEAR(speed->largest_deviation_mm, 0.4, 1e-12);
  EXPECT_FALSE(check_speed(trace, "retract", 120));
  EXPECT_EQ(trace_csv({}), "phase,time_s,commanded_mm,reported_mm\n");
}

}  // namespace
}  // namespace hydrodip
