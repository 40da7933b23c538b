#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "rig/rig.h"
#include "rig/run_record.h"
#include "virtual_bench.h"

namespace hydrodip {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

// Answers by the question's beginning; the time that an answer takes passes on the clock.
class ScriptedOperator : public Operator {
 public:
  explicit ScriptedOperator(Clock& clock) : clock_(clock) {}

  void say(const std::string& text) override { said += text + "\n"; }
  void show(const std::string&) override {}
  bool pressed_enter() override { return clock_.now_s() - asked_s_ >= soak_s; }
  std::string ask(const std::string& question) override {
    clock_.sleep(1);
    asked_s_ = clock_.now_s();
    if (question.find("broken off") != std::string::npos) return take_up;
    if (question.find("Type yes") != std::string::npos) return yes;
    if (question.find("or here") != std::string::npos) {
      if (jogs.empty()) return "here";
      const std::string jog = jogs.front();
      jogs.pop_front();
      return jog;
    }
    if (question.find("Temperature") != std::string::npos) return "28,5";
    if (question.find("Gun before") != std::string::npos) return "812.40";
    if (question.find("Gun after") != std::string::npos) return "808.90";
    return "";
  }

  std::string said, yes = "yes", take_up = "no";
  std::deque<std::string> jogs = {"60", "-2.5"};
  double soak_s = 70;

 private:
  Clock& clock_;
  double asked_s_ = 0;
};

class GuideTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ("rig_guide_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write_report(Json::object());
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_report(const Json& parameters) const {
    Json report = {{"schema_version", 1},
                   {"title", "mask"},
                   {"parameters", parameters},
                   {"figures", {{"depth_mm", 29.5}, {"object_size_mm", {100, 130, 29.5}}}}};
    write_file(folder_ / "report.json", report.dump());
  }

  RigJob job(const std::string& port) const {
    RigJob job = load_rig_job(folder_, {});
    job.config.stage.port = port;
    return job;
  }

  std::vector<Json> log(int run = 1) const {
    std::ifstream file(folder_ / ("rig-" + std::to_string(run)) / "log.jsonl");
    std::vector<Json> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(Json::parse(line));
    return lines;
  }

  static const Json* find(const std::vector<Json>& lines, const std::string& event) {
    for (const Json& line : lines)
      if (line["event"] == event) return &line;
    return nullptr;
  }

  fs::path folder_;
};

struct GuidedBench {
  GuidedBench() : emulator(zaber_emulator()), clock(*emulator), person(clock) {
    bench.open = [this](const StageOptions& options) -> std::unique_ptr<Link> {
      return std::make_unique<CountingLink>(open_serial(options.port, options.baud, clock), clock);
    };
  }
  std::unique_ptr<Emulator> emulator;
  VirtualClock clock;
  ScriptedOperator person;
  RunContext context;
  Bench bench{person, clock, {}};
};

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
