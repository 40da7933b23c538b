// A stage that does not do what it was told: slow, slipping, stuck, without its home, with less
// travel than it says. Each ends in a stop, and the message names it.
#include <gtest/gtest.h>

#include "session.h"

namespace hydrodip {
namespace {

constexpr ShortDip kLongDip{20, 180, 60};  // 160 s at 1 mm/s
constexpr double kCycle_s = 0.1;           // between two looks at the stage, answers included

class Watched : public ::testing::TestWithParam<Machine> {};

INSTANTIATE_TEST_SUITE_P(Mover, Watched, ::testing::Values(Machine::kZaber, Machine::kMarlin),
                         [](const auto& machine) {
                           return machine.param == Machine::kZaber ? "Zaber" : "Marlin";
                         });

// The fault begins half a second after the phase does.
Outcome dip_with(VirtualBench& bench, const std::string& phase, Fault fault) {
  std::optional<double> begun_s;
  bool struck = false;
  return run_dip(bench, kLongDip, [&](const TracePoint& point) {
    if (point.phase != phase || struck) return;
    if (!begun_s) begun_s = bench.clock.now_s();
    if (bench.clock.now_s() < *begun_s + 0.5) return;
    struck = true;
    fault.at_s = bench.clock.now_s();
    bench.emulator->add(fault);
  });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The number after `part`.
double figure_after(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + part.size()));
}

// A stop where the machine truly stands, as said.
void expect_stopped(VirtualBench& bench, const Outcome& outcome, const std::string& phase,
                    const std::string& words) {
  EXPECT_FALSE(outcome.finished);
  EXPECT_EQ(broken_promise(bench, outcome, kLongDip), "") << outcome.message;
  EXPECT_EQ(outcome.message.substr(0, phase.size() + 2), phase + ": ") << outcome.message;
  EXPECT_TRUE(contains(outcome.message, words)) << outcome.message;
  ASSERT_TRUE(outcome.rest);
  EXPECT_TRUE(outcome.rest->confirmed) << outcome.message;
}

double true_lag_mm(const VirtualBench& bench, const Outcome& outcome) {
  return std::abs(outcome.trace.back().commanded_mm - bench.emulator->position_mm());
}

TEST_P(Watched, ASlowStageIsStoppedOnceItIsTooFarBehind) {
  for (const double lost : {0.05, 0.3, 0.9}) {
    VirtualBench bench(GetParam());
    const Outcome outcome = dip_with(bench, "dip", {FaultKind::kSlow, 0, lost});
    expect_stopped(bench, outcome, "dip", "behind by ");
    const double allowed_mm = allowed_lag_mm(1), cycle_mm = kCycle_s * 1.0;
    EXPECT_NEAR(figure_after(outcome.message, "behind by "), allowed_mm + cycle_mm / 2,
                cycle_mm / 2 + 0.05);
    EXPECT_GT(true_lag_mm(bench, outcome), allowed_mm - cycle_mm);
    EXPECT_LT(true_lag_mm(bench, outcome), allowed_mm + 2 * cycle_mm);
  }
}

TEST_P(Watched, ASlipIsNoticedAtOnceEitherWay) {
  for (const double slip_mm : {2.3, -2.3}) {
    VirtualBench bench(GetParam());
    const Outcome outcome = dip_with(bench, "dip", {FaultKind::kSlip, 0, slip_mm});
    const std::string words = slip_mm > 0 ? "behind by " : "ahead by ";
    expect_stopped(bench, outcome, "dip", words);
    EXPECT_NEAR(figure_after(outcome.message, words), 2.3, 0.2);
    const double struck_mm = kLongDip.start_mm + 0.5;
    EXPECT_NEAR(bench.emulator->position_mm(), struck_mm - slip_mm, 0.3);
  }
}

TEST_P(Watched, ASlipThatTheStageMakesUpForDoesNoHarm) {
  VirtualBench bench(GetParam());
  const Outcome outcome = dip_with(bench, "dip", {FaultKind::kSlip, 0, 0.5});
  EXPECT_TRUE(outcome.finished) << outcome.message;
  EXPECT_EQ(broken_promise(bench, outcome, kLongDip), "");
}

// It neither goes on waiting nor moves when it comes free.
TEST_P(Watched, AStuckStageIsGivenUp) {
  for (const std::string phase : {"approach", "dip", "retract"}) {
    VirtualBench bench(GetParam());
    const Outcome outcome = dip_with(bench, phase, {FaultKind::kStick, 0, 1, 1.5});
    expect_stopped(bench, outcome, phase, "stuck");
    const double goal_mm = phase == "dip" ? kLongDip.bottom_mm : kLongDip.start_mm;
    EXPECT_NEAR(figure_after(outcome.message, "stuck "),
                std::abs(goal_mm - bench.emulator->position_mm()), 0.06);
  }
}

TEST_P(Watched, AMovementThatTakesTwiceAsLongIsGivenUp) {
  for (const std::string phase : {"approach", "retract"}) {
    VirtualBench bench(GetParam());
    const Outcome outcome = dip_with(bench, phase, {FaultKind::kSlow, 0, 0.97});
    expect_stopped(bench, outcome, phase, "from its goal after");
    const double planned_s = (phase == "approach" ? 20.0 : 160.0) / 15;
    EXPECT_NEAR(figure_after(outcome.message, "goal after "), 2 * planned_s + 5, 0.7);
  }
}

TEST_P(Watched, ALostHomeIsNoticedInEveryPhase) {
  for (const std::string phase : {"approach", "dip", "dwell", "retract"}) {
    VirtualBench bench(GetParam());
    bench.clock.at(0, [] {});
    double place_mm = 0;
    const Outcome outcome = [&] {
      std::optional<double> begun_s;
      return run_dip(bench, kLongDip, [&](const TracePoint& point) {
        if (point.phase != phase) return;
        if (!begun_s) {
          begun_s = bench.clock.now_s();
          bench.emulator->add({FaultKind::kBlink, *begun_s + 0.45, 1});
          bench.clock.at(*begun_s + 0.45, [&] { place_mm = bench.emulator->position_mm(); });
        }
      });
    }();
    expect_stopped(bench, outcome, phase, "forgotten its home");
    EXPECT_TRUE(contains(outcome.message, "no longer knows where")) << outcome.message;
    EXPECT_FALSE(outcome.rest->place_known);
    // What it counts now means nothing: where it was last seen is what is left.
    EXPECT_NEAR(outcome.rest->position_mm, place_mm, 2);
    EXPECT_NEAR(bench.emulator->position_mm(), place_mm, 0.5);
  }
}

TEST_P(Watched, ALostHomeWhileHomingIsNoticed) {
  VirtualBench bench(GetParam());
  bench.emulator->add({FaultKind::kBlink, 1, 1});
  const Outcome outcome = run_dip(bench, kLongDip);
  expect_stopped(bench, outcome, "homing",
                 GetParam() == Machine::kZaber ? "before it reached its home" : "silent");
}

TEST_P(Watched, AStageThatNeverGetsHomeIsGivenUp) {
  VirtualBench bench(GetParam());
  bench.emulator->add({FaultKind::kStick, 0.5, 1});
  const Outcome outcome = run_dip(bench, kLongDip);
  expect_stopped(bench, outcome, "homing", "does not find its home");
  EXPECT_NEAR(outcome.ended_s, 300, 10);
}

TEST_P(Watched, AStageThatSagsWhileItStandsIsNoticed) {
  for (const double sag_mm : {1.2, -1.2}) {
    VirtualBench bench(GetParam());
    const Outcome outcome = dip_with(bench, "dwell", {FaultKind::kSag, 0, sag_mm});
    // A printer says where it goes: that is seen before where it is.
    const bool printer = GetParam() == Machine::kMarlin;
    expect_stopped(bench, outcome, "dwell",
                   printer ? "mm, not to 180.00 mm as it was told" : "left its place by 1.2 mm");
  }
  // A printer would take it for a movement of its own.
  if (GetParam() == Machine::kMarlin) return;
  VirtualBench bench(GetParam());
  EXPECT_TRUE(dip_with(bench, "dwell", {FaultKind::kSag, 0, 0.9}).finished);
}

// The printer of the Marlin kind stops where its firmware says, without a word.
TEST_P(Watched, LessTravelThanItSaysEndsInAStop) {
  for (const bool lower : {true, false})
    for (const bool steady : {true, false}) {
      VirtualBench bench(GetParam());
      bench.emulator->add({FaultKind::kShortTravel, 0, 5});
      bench.clock.sleep(0.1);
      Mover mover(*bench.stage, bench.clock, bench.context);
      mover.allow_motion();
      mover.home();
      const double end_mm = lower ? 0 : mover.identity().max_mm - 5;
      mover.move_to("approach", end_mm + (lower ? 10 : -10), 1500, false);
      try {
        mover.move_to("beyond", end_mm + (lower ? -3 : 3), 300, steady);
        ADD_FAILURE() << "it says that it got there";
      } catch (const StageError& error) {
        EXPECT_TRUE(contains(error.what(), "travel ends earlier")) << error.what();
      }
      // At its end, or, where a printer says that it goes no further, on the way there.
      const double before_mm = (bench.emulator->position_mm() - end_mm) * (lower ? 1 : -1);
      EXPECT_GE(before_mm, -0.003);
      EXPECT_LE(before_mm, GetParam() == Machine::kMarlin ? 10 : 0.003);
      EXPECT_FALSE(bench.emulator->moving());
    }
}

// Not the machine's refusal: nothing is even sent.
TEST_P(Watched, NoTargetBeyondTheTravelIsSent) {
  VirtualBench bench(GetParam());
  Mover mover(*bench.stage, bench.clock, bench.context);
  mover.allow_motion();
  mover.home();
  const double step_mm = mover.identity().step_mm;
  const std::size_t sent = bench.clock.sent;
  for (const double beyond_mm :
       {mover.identity().min_mm - 2 * step_mm, mover.identity().max_mm + 2 * step_mm}) {
    try {
      mover.move_to("dip", beyond_mm, 100, true);
      ADD_FAILURE() << "it moved";
    } catch (const StageError& error) {
      EXPECT_TRUE(contains(error.what(), "beyond the stage's travel")) << error.what();
    }
  }
  EXPECT_EQ(bench.clock.sent, sent);
  mover.require_within_limits(mover.identity().min_mm);
  mover.require_within_limits(mover.identity().max_mm);
}

// Ctrl-C just before a movement: it does not even begin.
TEST_P(Watched, NoMovementBeginsAfterCtrlC) {
  VirtualBench bench(GetParam());
  Mover mover(*bench.stage, bench.clock, bench.context);
  mover.allow_motion();
  bench.context.cancel();
  EXPECT_THROW(mover.home(), Cancelled);
  EXPECT_FALSE(bench.emulator->moving());
  EXPECT_EQ(bench.emulator->last_start_s(), 0);
}

// A lost home behind a fault is still lost.
TEST_P(Watched, AFaultDoesNotHideThatHomeIsLost) {
  VirtualBench bench(GetParam());
  const Outcome outcome = run_dip(bench, kLongDip, [&](const TracePoint& point) {
    if (point.phase != "dip" || point.commanded_mm < 25 || bench.emulator->moved_unhomed()) return;
    bench.emulator->add({FaultKind::kBlink, bench.clock.now_s(), 1, 0.01});
    bench.emulator->add({FaultKind::kStall, bench.clock.now_s() + 0.002, 1, 0.01});
  });
  EXPECT_FALSE(outcome.finished);
  ASSERT_TRUE(outcome.rest);
  EXPECT_FALSE(outcome.rest->place_known) << outcome.message;
}

// The leash runs dry: in a steady dip the film would see it, on the way there nobody does.
TEST_P(Watched, AComputerThatComesTooLateIsAnErrorInASteadyDipOnly) {
  for (const std::string phase : {"approach", "dip"}) {
    VirtualBench bench(GetParam());
    std::optional<double> begun_s;
    double before_mm = 0;
    const Outcome outcome = run_dip(bench, kLongDip, [&](const TracePoint& point) {
      if (point.phase != phase || begun_s) return;
      begun_s = bench.clock.now_s();
      bench.clock.at(*begun_s + 0.5, [&] {
        before_mm = bench.emulator->position_mm();
        bench.clock.hiccup(0.7);
      });
    });
    if (phase == "approach") {
      EXPECT_TRUE(outcome.finished) << outcome.message;
      continue;
    }
    expect_stopped(bench, outcome, "dip", "had to wait");
    // 1 mm/s, and no target farther than the leash.
    EXPECT_LE(bench.emulator->position_mm(), before_mm + 1.0 * kLeash_s + 0.01);
  }
}

// However long the program is away.
TEST_P(Watched, AProgramThatDiesLeavesALeashBehind) {
  VirtualBench bench(GetParam());
  std::optional<double> begun_s;
  double before_mm = 0;
  run_dip(bench, {20, 180, 300}, [&](const TracePoint& point) {
    if (point.phase != "dip" || begun_s) return;
    begun_s = bench.clock.now_s();
    bench.clock.at(*begun_s + 2, [&] {
      before_mm = bench.emulator->position_mm();
      bench.clock.hiccup(60);
    });
  });
  EXPECT_GT(bench.emulator->position_mm(), before_mm);
  EXPECT_LE(bench.emulator->position_mm(), before_mm + 5.0 * kLeash_s + 0.01);
}

// ---- the mover and the drivers, each without the other's help ----

// Goes to wherever it is sent in no time.
class PaperStage : public Stage {
 public:
  StageIdentity connect() override { return {"paper", 0, 100, 0.001}; }
  StageState state() override {
    ++looks;
    if (spoil) spoil(now);
    return now;
  }
  void acknowledge() override {}
  void start_homing() override { now.homed = now.position_known = true; }
  void set_speed(double mm_per_min) override { speed_mm_per_min = mm_per_min; }
  void aim(double position_mm) override { now.position_mm = position_mm; }
  void stop() override { ++stops; }
  void halt() override { ++halts; }

  StageState now;
  std::function<void(StageState&)> spoil;
  int looks = 0, stops = 0, halts = 0;
  double speed_mm_per_min = 0;
};

class PaperClock : public Clock {
 public:
  double now_s() override { return now_s_; }
  bool wait_readable(int, double seconds) override {
    now_s_ += seconds;
    return false;
  }
  std::string utc() override { return ""; }

 private:
  double now_s_ = 0;
};

struct PaperBench {
  PaperBench() { mover.allow_motion(); }
  // What a movement says when the stage's state is spoilt from its fourth look on.
  std::string spoilt(const std::function<void(StageState&)>& spoil, bool dwell = false) {
    mover.home();
    stage.looks = 0;
    stage.spoil = [this, spoil](StageState& state) {
      if (stage.looks >= 4 && stage.stops == 0) spoil(state);
    };
    try {
      if (dwell)
        mover.dwell("dwell", 10);
      else
        mover.move_to("dip", 50, 60, false);
    } catch (const StageError& error) {
      return error.what();
    }
    return "";
  }
  PaperStage stage;
  PaperClock clock;
  RunContext context;
  Mover mover{stage, clock, context};
};

TEST(PaperBench, WhatTheStageSaysOfItselfStopsIt) {
  for (const bool dwell : {false, true}) {
    PaperBench home;
    EXPECT_TRUE(
        contains(home.spoilt([](StageState& s) { s.homed = false; }, dwell), "forgotten its home"));
    EXPECT_EQ(home.stage.stops, 1);
    PaperBench fault;
    EXPECT_TRUE(
        contains(fault.spoilt([](StageState& s) { s.fault = "it burns"; }, dwell), "it burns"));
    EXPECT_EQ(fault.stage.stops, 1);
    PaperBench sound;
    EXPECT_EQ(sound.spoilt([](StageState&) {}, dwell), "");
    EXPECT_EQ(sound.stage.stops, 0);
  }
}

TEST(PaperBench, NoMovementBeginsWithAFaultOrWhileAnotherIsUnderWay) {
  for (int i = 0; i < 3; ++i) {
    PaperBench bench;
    bench.mover.home();
    bench.stage.now.homed = i != 0;
    bench.stage.now.moving = i == 1;
    bench.stage.now.fault = i == 2 ? "it burns" : "";
    bench.stage.spoil = [&](StageState& state) {
      if (bench.stage.stops > 0) state.moving = false;
    };
    EXPECT_THROW(bench.mover.move_to("dip", 50, 60, false), StageError);
    EXPECT_EQ(bench.stage.speed_mm_per_min, 0);
  }
}

// A position that never ends to change keeps no movement alive.
TEST(PaperBench, AStageThatTremblesForEverIsGivenUp) {
  PaperBench bench;
  double sign = 1;
  const std::string message = bench.spoilt([&](StageState& state) {
    state.position_mm = 20 + (sign = -sign);
    state.moving = true;
  });
  EXPECT_TRUE(contains(message, "after 105 s, where 50 s were planned")) << message;
}

TEST(PaperBench, ASecondCtrlCHaltsAtOnce) {
  PaperBench bench;
  bench.mover.home();
  bench.stage.looks = 0;
  bench.stage.spoil = [&](StageState& state) {
    state.moving = bench.stage.looks > 1 && bench.stage.halts == 0;
    if (bench.stage.looks == 4 || bench.stage.looks == 7) bench.context.cancel();
  };
  EXPECT_THROW(bench.mover.move_to("dip", 50, 60, false), Cancelled);
  EXPECT_EQ(bench.stage.stops, 1);
  EXPECT_EQ(bench.stage.halts, 1);
  ASSERT_TRUE(bench.mover.last_rest());
  EXPECT_TRUE(bench.mover.last_rest()->confirmed);
}

// What arrives over a bad link may be an answer of long ago, and the stop may have been lost on it.
TEST(PaperBench, OverABadLinkTheStopIsRepeatedAndOldAnswersDoNotCount) {
  PaperBench bench;
  bench.mover.home();
  bench.stage.looks = 0;
  bool lost = false;
  double lost_s = 0;
  bench.stage.spoil = [&](StageState&) {
    if (bench.stage.looks == 4) bench.context.cancel();
    if (bench.stage.stops == 0 || lost) return;
    lost = true;
    lost_s = bench.clock.now_s();
    throw LinkError("nothing was heard");
  };
  EXPECT_THROW(bench.mover.move_to("dip", 50, 60, false), Cancelled);
  EXPECT_EQ(bench.stage.stops, 2);
  EXPECT_GE(bench.clock.now_s() - lost_s, 2.5);
  ASSERT_TRUE(bench.mover.last_rest());
  EXPECT_TRUE(bench.mover.last_rest()->confirmed);
}

// A homed stage of either make on which the home is lost or which grows too hot between two looks:
// already the answer to the next command says so.
TEST_P(Watched, TheDriverRefusesToAimAStageWithoutHomeOrWithAFault) {
  for (const bool blink : {true, false}) {
    VirtualBench bench(GetParam());
    bench.stage->connect();
    bench.stage->start_homing();
    do bench.clock.sleep(0.1);
    while (!bench.stage->state().homed);
    bench.stage->set_speed(60);
    bench.stage->aim(5);
    bench.emulator->add({blink ? FaultKind::kBlink : FaultKind::kOverheat, bench.clock.now_s(), 1});
    bench.clock.sleep(0.1);
    try {
      bench.stage->aim(6);
      ADD_FAILURE() << "it took the command";
    } catch (const StageError& error) {
      EXPECT_TRUE(contains(error.what(), blink                            ? "forgotten its home"
                                         : GetParam() == Machine::kMarlin ? "MAXTEMP"
                                                                          : "too hot"))
          << error.what();
    }
    if (blink) {
      EXPECT_FALSE(bench.stage->state().homed);
    }
  }
}

}  // namespace
}  // namespace hydrodip
