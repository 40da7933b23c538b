// One dip without people: home, approach, dip, retract; and what there is to say about it after.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "virtual_bench.h"

namespace hydrodip {

struct Outcome {
  bool finished = false;
  std::string message;  // of what was thrown
  std::optional<Rest> rest;
  Trace trace;
  double ended_s = 0;
};

struct ShortDip {
  double start_mm = 20, bottom_mm = 40;
  double mm_per_min = 300;
};

using OnPoint = std::function<void(const TracePoint&)>;

inline Outcome run_dip(VirtualBench& bench, const ShortDip& dip, const OnPoint& on_point = {}) {
  Outcome outcome;
  std::optional<Mover> mover;
  try {
    mover.emplace(*bench.stage, bench.clock, bench.context);
    mover->on_point(on_point);
    mover->allow_motion();
    mover->home();
    mover->move_to("approach", dip.start_mm, 900, false);
    mover->move_to("dip", dip.bottom_mm, dip.mm_per_min, true);
    mover->dwell("dwell", 1);
    mover->move_to("retract", dip.start_mm, 900, false);
    outcome.finished = true;
  } catch (const std::runtime_error& error) {
    outcome.message = error.what();
  }
  if (mover) {
    outcome.rest = mover->last_rest();
    outcome.trace = mover->trace();
  }
  outcome.ended_s = bench.clock.now_s();
  return outcome;
}

// Of those that are drawn and end.
inline constexpr double kLongestFault_s = 20;

// A stage that was stuck when its link was lost goes on to the end of its leash once it comes free;
// whoever could not ask it says so.
bool runs_out_later(const Emulator& machine, const std::string& message);

// Why the outcome is not as promised; "" if it is. Lets some time pass, for late movements.
std::string broken_promise(VirtualBench& bench, const Outcome& outcome, const ShortDip& dip);

// Judges a movement from its plan, the clock and where the machine truly is: a stop is due as soon
// as the machine is not where it should be, or does not get on.
class Referee {
 public:
  Referee(Emulator& machine, VirtualClock& clock) : machine_(machine), clock_(clock) {}
  // Begins to look, a hundred times a second.
  void start();
  void movement(const std::string& phase, double goal_mm, double steady_mm_per_min);
  void standstill() { phase_.clear(); }

 private:
  void look();

  Emulator& machine_;
  VirtualClock& clock_;
  std::string phase_;
  double start_s_ = 0, start_mm_ = 0, goal_mm_ = 0, mm_per_s_ = 0;
  double place_mm_ = 0, moved_s_ = 0;
};

// Draws faults and Ctrl-Cs by the seed and says what; they come up to `until_s`. What they make due
// is told to the machine.
std::string draw_faults(unsigned seed, double until_s, Emulator& machine, VirtualClock& clock,
                        const RunContext& context);

// A dip with faults drawn by the seed; the complaint of broken_promise.
std::string random_faults(Machine machine, unsigned seed, std::string& story);

}  // namespace hydrodip
