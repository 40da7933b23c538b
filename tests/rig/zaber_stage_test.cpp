// What the Zaber driver makes of answers: only the one to this very question counts, and a refusal
// is an error.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "rig/stage.h"
#include "virtual_bench.h"

namespace hydrodip {
namespace {

// Time passes while nothing arrives.
class IdleClock : public Clock {
 public:
  double now_s() override { return now_s_; }
  std::string utc() override { return "2026-01-31T12:00:00Z"; }
  bool wait_readable(int, double seconds) override {
    now_s_ += seconds;
    return false;
  }
  void pass(double seconds) { now_s_ += seconds; }

 private:
  double now_s_ = 0;
};

// A stage that answers every question of its place with the next higher number, and may answer the
// first ones too late: after the next question.
class TardyStage : public Link {
 public:
  TardyStage(IdleClock& clock, int late) : clock_(clock), late_(late) {}

  void send(const std::string& command) override {
    const std::string id = command.substr(5, 2);  // "/1 0 07 get pos:XX"
    for (std::string& line : kept_) arrived_.push_back(std::move(line));
    kept_.clear();
    std::string line = fmt::format("@01 0 {} OK IDLE -- {}\r\n", id, 1000 * ++questions_);
    (questions_ <= late_ ? kept_ : arrived_).push_back(std::move(line));
  }
  std::string receive(double seconds) override {
    if (arrived_.empty()) {
      clock_.pass(seconds);
      return "";
    }
    std::string line = std::move(arrived_.front());
    arrived_.pop_front();
    return line;
  }

 private:
  IdleClock& clock_;
  int late_ = 0, questions_ = 0;
  std::deque<std::string> kept_, arrived_;
};

// Else every place that is told from then on would be that of the question before.
TEST(ZaberStage, ALateAnswerIsNotThatToTheNextQuestion) {
  for (const int late : {0, 1}) {
    IdleClock clock;
    TardyStage link(clock, late);
    const StageOptions options;
    const auto stage = zaber_stage(link, clock, options);
    for (int question = 1; question <= 3; ++question)
      EXPECT_NEAR(stage->state().position_mm,
                  1e-3 * options.microstep_um * 1000 * (question + late), 1e-9)
          << late;
  }
}

void wait_until_home(VirtualBench& bench) {
  bench.stage->start_homing();
  for (int n = 0; n < 2000 && bench.stage->state().moving; ++n) bench.clock.sleep(0.1);
  ASSERT_TRUE(bench.stage->state().homed);
}

TEST(ZaberStage, WhatTheStageRefusesIsSaid) {
  VirtualBench bench(Machine::kZaber);
  const StageIdentity identity = bench.stage->connect();
  wait_until_home(bench);
  const double before_mm = bench.emulator->position_mm();
  for (const auto& [command, ask] :
       {std::pair<std::string, std::function<void()>>{
            "move abs", [&] { bench.stage->aim(identity.max_mm + 50); }},
        {"set maxspeed 0", [&] { bench.stage->set_speed(0); }}})
    try {
      ask();
      ADD_FAILURE() << command << " was refused without a word";
    } catch (const StageError& error) {
      EXPECT_NE(std::string(error.what()).find("refused '" + command), std::string::npos)
          << error.what();
    }
  bench.clock.sleep(1);
  EXPECT_EQ(bench.emulator->position_mm(), before_mm);
}

}  // namespace
}  // namespace hydrodip
