// One dip without people: home, approach, dip, retract; and what there is to say about it after.
#pragma once

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

inline Outcome run_dip(VirtualBench& bench, const ShortDip& dip) {
  Outcome outcome;
  std::optional<Mover> mover;
  try {
    mover.emplace(*bench.stage, bench.clock, bench.context);
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

// Why the outcome is not as promised; "" if it is. Lets some time pass, for late movements.
std::string broken_promise(VirtualBench& bench, const Outcome& outcome, const ShortDip& dip);

// A dip with faults drawn by the seed; the complaint of broken_promise.
std::string random_faults(Machine machine, unsigned seed, std::string& story);

}  // namespace hydrodip
