#include "rig/mover.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "contains.h"
#include "session.h"

namespace hydrodip {
namespace {

class BothMachines : public ::testing::TestWithParam<Machine> {
 protected:
  double step_mm() const { return GetParam() == Machine::kZaber ? 0.00049609375 : 0.0025; }
};

INSTANTIATE_TEST_SUITE_P(Mover, BothMachines, ::testing::Values(Machine::kZaber, Machine::kMarlin),
                         [](const auto& machine) {
                           return machine.param == Machine::kZaber ? "Zaber" : "Marlin";
                         });

TEST_P(BothMachines, DipIsExactInSpeedAndDepth) {
  VirtualBench bench(GetParam());
  Mover mover(*bench.stage, bench.clock, bench.context);
  mover.allow_motion();
  mover.home();
  mover.move_to("approach", 15, 600, false);
  mover.move_to("dip", 47.3, 100, true);
  EXPECT_NEAR(bench.emulator->position_mm(), 47.3, step_mm());
  EXPECT_FALSE(bench.emulator->moving());
  // As the machine itself moved, whatever it reported.
  EXPECT_NEAR(bench.emulator->measured_speed_mm_per_min(16, 46), 100, 1);
  for (double from = 16; from < 45; from += 2)
    EXPECT_NEAR(bench.emulator->measured_speed_mm_per_min(from, from + 2), 100, 1);
  const auto speed = check_speed(mover.trace(), "dip", 100);
  ASSERT_TRUE(speed);
  EXPECT_LT(std::abs(speed->error_percent()), 1);
}

TEST_P(BothMachines, NothingMovesWithoutPermissionOrHome) {
  VirtualBench bench(GetParam());
  const double place_mm = bench.emulator->position_mm();
  Mover mover(*bench.stage, bench.clock, bench.context);
  EXPECT_THROW(mover.home(), std::logic_error);
  EXPECT_THROW(mover.move_to("dip", 10, 100, true), std::logic_error);
  mover.allow_motion();
  EXPECT_THROW(mover.move_to("dip", 10, 100, true), StageError);
  EXPECT_EQ(bench.emulator->position_mm(), place_mm);
  EXPECT_FALSE(bench.emulator->moved_unhomed());
}

TEST_P(BothMachines, StaysWithinItsTravel) {
  VirtualBench bench(GetParam());
  Mover mover(*bench.stage, bench.clock, bench.context);
  mover.allow_motion();
  mover.home();
  EXPECT_THROW(mover.move_to("dip", mover.identity().max_mm + 1, 100, true), StageError);
  EXPECT_THROW(mover.move_to("dip", -1, 100, true), StageError);
  EXPECT_EQ(bench.emulator->position_mm(), 0);
}

// Ctrl-C in mid-dip: stands within the promised time, and far before the goal.
TEST_P(BothMachines, CtrlCStops) {
  for (const int presses : {1, 2}) {
    VirtualBench bench(GetParam());
    for (int i = 0; i < presses; ++i)
      bench.clock.at(22 + 0.01 * i, [&] {
        bench.context.cancel();
        bench.emulator->stop_due(bench.clock.now_s() + 0.4);
      });
    const ShortDip dip{20, 180, 60};
    const Outcome outcome = run_dip(bench, dip);
    EXPECT_FALSE(outcome.finished);
    ASSERT_TRUE(outcome.rest);
    EXPECT_TRUE(outcome.rest->confirmed);
    EXPECT_EQ(broken_promise(bench, outcome, dip), "");
    EXPECT_LT(bench.emulator->position_mm(), 60);
  }
}

struct Case {
  FaultKind kind;
  double value;
  std::optional<bool> confirmed;  // whether the stage can still be asked after
};

// Slower than a step in a few milliseconds: two looks in a row see it at the same place.
TEST_P(BothMachines, AStageThatRunsOutIsNotSaidToStand) {
  VirtualBench bench(GetParam());
  Mover mover(*bench.stage, bench.clock, bench.context);
  mover.allow_motion();
  mover.home();
  for (const double mm_per_min : {2, 20, 200}) {
    const double start_mm = bench.emulator->position_mm();
    bench.stage->set_speed(mm_per_min);
    bench.stage->aim(start_mm + 20);
    bench.clock.sleep(1);
    bench.stage->state();
    bench.stage->stop();
    int looks = 0;
    for (; bench.stage->state().moving; ++looks) {
      ASSERT_LT(looks, 1000);
      bench.clock.sleep(0.001);
    }
    EXPECT_FALSE(bench.emulator->moving()) << mm_per_min;
    const double rest_mm = bench.emulator->position_mm();
    bench.clock.sleep(1);
    EXPECT_EQ(bench.emulator->position_mm(), rest_mm);
  }
}

TEST_P(BothMachines, EveryFaultInMidDipEndsInAStoppedStageAndAClearMessage) {
  const std::vector<Case> cases = {
      {FaultKind::kGarbleReplies, 1, false}, {FaultKind::kGarbleCommands, 1, false},
      {FaultKind::kSlowReplies, 1.0, {}},    {FaultKind::kSilence, 1, false},
      {FaultKind::kUnplug, 1, false},        {FaultKind::kStall, 1, true},
      {FaultKind::kOverheat, 1, true}};
  for (const Case& fault : cases) {
    SCOPED_TRACE(static_cast<int>(fault.kind));
    VirtualBench bench(GetParam());
    const ShortDip dip{20, 180, 60};
    bench.emulator->add({fault.kind, 40, fault.value});
    bench.clock.at(40, [&] { bench.emulator->stop_due(40 + kLongestStop_s); });
    const Outcome outcome = run_dip(bench, dip);
    EXPECT_FALSE(outcome.finished);
    EXPECT_EQ(broken_promise(bench, outcome, dip), "") << outcome.message;
    ASSERT_TRUE(outcome.rest);
    if (fault.confirmed) {
      EXPECT_EQ(outcome.rest->confirmed, *fault.confirmed) << outcome.message;
    }
    EXPECT_EQ(outcome.message.substr(0, 5), "dip: ") << outcome.message;
    EXPECT_LT(bench.emulator->position_mm(), 60);
  }
}

TEST_P(BothMachines, AFewGarbledBytesDoNoHarm) {
  VirtualBench bench(GetParam(), 7);
  bench.emulator->add({FaultKind::kGarbleReplies, 0, 0.01});
  bench.emulator->add({FaultKind::kGarbleCommands, 0, 0.01});
  const ShortDip dip;
  const Outcome outcome = run_dip(bench, dip);
  EXPECT_TRUE(outcome.finished) << outcome.message;
  EXPECT_EQ(broken_promise(bench, outcome, dip), "");
}

TEST(ZaberStage, RefusesAStageWithAnotherScrew) {
  VirtualBench bench(Machine::kZaber);
  bench.options.microstep_um = 0.1984375;
  const auto stage = make_stage(bench.link, bench.clock, bench.options);
  EXPECT_THROW(stage->connect(), StageError);
}

TEST(ZaberStage, OverheatedBeforeTheStartMovesNothing) {
  VirtualBench bench(Machine::kZaber);
  bench.emulator->add({FaultKind::kOverheat, 0, 1});
  bench.clock.sleep(0.1);
  const double place_mm = bench.emulator->position_mm();
  const Outcome outcome = run_dip(bench, {});
  EXPECT_NE(outcome.message.find("too hot"), std::string::npos) << outcome.message;
  EXPECT_EQ(bench.emulator->position_mm(), place_mm);
}

std::string stage_error(const std::function<void()>& action) {
  try {
    action();
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

// A printer that says ok to its stop and goes on, as when two wrong bits made another command of
// it.
class DeafPrinter : public Link, public Clock {
 public:
  DeafPrinter(double steps_per_s, bool tells_its_goal)
      : steps_per_s_(steps_per_s), tells_its_goal_(tells_its_goal) {}

  double now_s() override { return now_s_; }
  bool wait_readable(int, double seconds) override {
    now_s_ += seconds;
    return false;
  }
  std::string utc() override { return ""; }

  void send(const std::string& bytes) override {
    const auto says = [&](const char* command) { return bytes.find(command) != std::string::npos; };
    const long steps = std::lround(12000 + now_s_ * steps_per_s_);
    if (says("M115")) answer_ += "FIRMWARE_NAME:deaf SOURCE_CODE\n";
    if (says("M92")) answer_ += "M92 X80.00 Z" + steps_per_mm + "\n";
    if (says("M211")) answer_ += "Min: X0.00 Z0.00 Max: X200.00 Z" + top_mm + "\n";
    if (asks_again_for) answer_ += "Resend: " + *asks_again_for + "\n";
    if (says("M114"))
      answer_ += fmt::format("X:0.00 Y:0.00 Z:{:.2f} E:0.00 Count X:0 Y:0 Z:{}\n",
                             tells_its_goal_ ? 150.0 : double(steps) / 400, steps);
    if (says("G1 ")) ++sent_on;
    answer_ += says("M112") ? "Error:Printer halted. kill() called!\n" : "ok\n";
  }
  std::string receive(double) override {
    now_s_ += 0.0005;
    return std::exchange(answer_, "");
  }

  int sent_on = 0;
  std::string steps_per_mm = "400.00", top_mm = "200.00";
  std::optional<std::string> asks_again_for;

 private:
  double steps_per_s_;
  bool tells_its_goal_;
  double now_s_ = 0;
  std::string answer_;
};

// What no printer means, if a link or a wrong setting makes it say so.
TEST(MarlinStage, NumbersThatCannotBeAreRefused) {
  for (const char* steps : {"0.00", "-400.00", "nan", "inf", "1e300"}) {
    DeafPrinter printer(0, false);
    printer.steps_per_mm = steps;
    const auto stage = marlin_stage(printer, printer, {});
    EXPECT_TRUE(contains(stage_error([&] { stage->connect(); }), "M92")) << steps;
  }
  for (const char* top : {"0.00", "-5.00", "inf", "1e300"}) {
    DeafPrinter printer(0, false);
    printer.top_mm = top;
    const auto stage = marlin_stage(printer, printer, {});
    EXPECT_TRUE(contains(stage_error([&] { stage->connect(); }), "M211")) << top;
  }
  for (const char* line : {"1e30", "-3", "1.5", "nan", "", "99999999999"}) {
    DeafPrinter printer(0, false);
    const auto stage = marlin_stage(printer, printer, {});
    stage->connect();
    printer.asks_again_for = line;
    EXPECT_TRUE(contains(stage_error([&] { stage->set_speed(100); }), "Resend")) << line;
    stage->start_homing();
    EXPECT_TRUE(contains(stage_error([&] {
                           while (stage->state().moving) printer.sleep(0.1);
                         }),
                         "has not got the command to home"))
        << line;
  }
}

TEST(MarlinStage, NeverStandsWhileItGoesOn) {
  // Slower than anybody sees in a while, but it says where it goes; or a step in every few looks.
  for (const auto& [steps_per_s, tells_its_goal] : {std::pair{0.5, true}, {200.0, false}}) {
    DeafPrinter printer(steps_per_s, tells_its_goal);
    const auto stage = marlin_stage(printer, printer, {});
    stage->connect();
    stage->state();
    printer.sleep(4);
    EXPECT_TRUE(stage->state().moving) << "whoever sent it";
    stage->stop();
    for (int look = 0; look < 300; ++look) {
      ASSERT_TRUE(stage->state().moving) << steps_per_s << " steps/s, look " << look;
      printer.sleep(0.001);
    }
  }
}

TEST(MarlinStage, AHaltedPrinterIsNotSentOn) {
  DeafPrinter printer(0, false);
  const auto stage = marlin_stage(printer, printer, {});
  stage->connect();
  stage->halt();
  EXPECT_THROW(stage->aim(50), StageError);
  EXPECT_EQ(printer.sent_on, 0);
  EXPECT_FALSE(stage->state().fault.empty());
}

// What others have left a printer in does not matter.
TEST(MarlinStage, DipsTrulyWhateverItWasLeftIn) {
  for (const MarlinHabits& habits :
       {MarlinHabits{.feed_percent = 90}, MarlinHabits{.feed_percent = 160},
        MarlinHabits{.inches = true}, MarlinHabits{.home_offset_mm = -2},
        MarlinHabits{.home_offset_mm = 3.4567}}) {
    VirtualBench bench(habits);
    const Outcome outcome = run_dip(bench, {});
    EXPECT_TRUE(outcome.finished) << outcome.message;
    EXPECT_NEAR(bench.emulator->measured_speed_mm_per_min(22, 36), 300, 3);
    // As the printer counts; what it shows ends two digits after the point.
    double lowest_mm = 0, told_mm = 0;
    for (const TracePoint& point : outcome.trace) told_mm = std::max(told_mm, point.reported_mm);
    Mover mover(*bench.stage, bench.clock, bench.context);
    mover.allow_motion();
    mover.home();
    mover.move_to("dip", 40, 900, false);
    lowest_mm = bench.emulator->position_mm();
    EXPECT_NEAR(lowest_mm, 40 - habits.home_offset_mm, 0.006);
    EXPECT_NEAR(told_mm, 40, 0.006);
  }
}

TEST(MarlinStage, StopsWhereItShowsAnotherPlaceThanItsStepsComeTo) {
  VirtualBench bench(MarlinHabits{.home_offset_mm = 3.4567});
  bench.clock.at(8, [&] { bench.context.cancel(); });
  const Outcome outcome = run_dip(bench, {20, 40, 60});
  EXPECT_FALSE(outcome.finished);
  ASSERT_TRUE(outcome.rest);
  EXPECT_TRUE(outcome.rest->confirmed) << outcome.message;
  EXPECT_NEAR(outcome.rest->position_mm, bench.emulator->position_mm() + 3.4567, 0.006);
}

TEST(MarlinStage, HomingThatDidNotHappenIsNoHome) {
  VirtualBench bench(MarlinHabits{.wants_xy_first = true});
  const double place_mm = bench.emulator->position_mm();
  const Outcome outcome = run_dip(bench, {});
  EXPECT_NE(outcome.message.find("has not homed Z ('echo:Home XY First')"), std::string::npos)
      << outcome.message;
  EXPECT_FALSE(bench.stage->state().homed);
  EXPECT_EQ(bench.emulator->position_mm(), place_mm);
  EXPECT_FALSE(bench.emulator->moved_unhomed());
}

TEST(MarlinStage, HomeIsAtTheTop) {
  // Counts upward to its top.
  VirtualBench good(MarlinHabits{.home_mm = 200}, StageDown::kMinus);
  good.emulator->stand_at(-30);
  const Outcome outcome = run_dip(good, {180, 160, 300});
  EXPECT_TRUE(outcome.finished) << outcome.message;
  EXPECT_NEAR(good.emulator->position_mm(), -20, 0.003);
  // Towards its bed.
  for (const auto& [home_mm, down] : {std::pair{0., StageDown::kMinus}, {200., StageDown::kPlus}}) {
    VirtualBench bench(MarlinHabits{.home_mm = home_mm}, down);
    const Outcome refused = run_dip(bench, {});
    EXPECT_NE(refused.message.find("it must home Z away from the bath"), std::string::npos)
        << refused.message;
    EXPECT_FALSE(bench.stage->state().homed);
  }
}

TEST(MarlinStage, HomingThatWasGarbledIsAskedForAgain) {
  VirtualBench bench(Machine::kMarlin);
  bench.stage->connect();
  bench.emulator->add({FaultKind::kGarbleCommands, bench.clock.now_s(), 1, 0.002});
  bench.stage->start_homing();
  StageState state;
  do {
    bench.clock.sleep(0.1);
    state = bench.stage->state();
  } while (state.moving);
  EXPECT_TRUE(state.homed);
  EXPECT_TRUE(bench.emulator->homed());
  EXPECT_EQ(bench.emulator->position_mm(), 0);
}

TEST_P(BothMachines, StandsStillAtTheFirstLook) {
  VirtualBench bench(GetParam());
  Mover mover(*bench.stage, bench.clock, bench.context);
  EXPECT_FALSE(mover.state().moving);
}

// Reasons that end as a question need no full stop.
TEST(MarlinStage, AnErrorIsASentence) {
  VirtualBench bench(Machine::kMarlin);
  bench.emulator->add({FaultKind::kBlink, 12, 1, 0.01});
  const Outcome outcome = run_dip(bench, {20, 120, 60});
  EXPECT_NE(outcome.message.find("was its power cut? "), std::string::npos) << outcome.message;
}

// Two wrong bits in a command looked right, and sent it 0.005 mm further than promised.
TEST(MarlinStage, KeepsItsPromiseWhereTheLinkGarblesUnseen) {
  std::string story;
  EXPECT_EQ(random_faults(Machine::kMarlin, 1725, story), "") << story;
  EXPECT_NE(story.find("at the latest"), std::string::npos) << story;
}

TEST_P(BothMachines, FiftyRandomFaultSequencesLeaveNothingMoving) {
  int finished = 0;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    std::string story;
    EXPECT_EQ(random_faults(GetParam(), seed, story), "") << story;
    finished += story.ends_with("finished") ? 1 : 0;
  }
  // Some faults must come too late or too weak to matter, or the draw tests only one thing.
  EXPECT_GT(finished, 0);
  EXPECT_LT(finished, 25);
}

}  // namespace
}  // namespace hydrodip
