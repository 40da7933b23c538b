#include "session.h"

#include <fmt/format.h>

#include <random>

namespace hydrodip {
namespace {

constexpr double kStep_mm = 0.0025;  // the coarser machine's

const char* name(FaultKind kind) {
  constexpr const char* kNames[] = {"garbled replies", "garbled commands", "slow replies",
                                    "silence",         "unplugged",        "stall",
                                    "overheated",      "power cut"};
  return kNames[static_cast<int>(kind)];
}

// Homing is the stage's own movement: without a link it runs to its end.
bool leaves_homing_alone(FaultKind kind) {
  return kind == FaultKind::kSilence || kind == FaultKind::kUnplug ||
         kind == FaultKind::kSlowReplies;
}

bool makes_stop_due(FaultKind kind, double value) {
  return kind == FaultKind::kSilence || kind == FaultKind::kUnplug || kind == FaultKind::kStall ||
         kind == FaultKind::kOverheat || kind == FaultKind::kPowerCut ||
         (kind == FaultKind::kSlowReplies && value > kReplyTimeout_s);
}

}  // namespace

std::string broken_promise(VirtualBench& bench, const Outcome& outcome, const ShortDip& dip) {
  Emulator& machine = *bench.emulator;
  const bool confirmed = outcome.rest && outcome.rest->confirmed;
  const bool homing = outcome.rest && outcome.rest->homing && !confirmed;
  if (machine.moving() && !homing) return "the run is over and the machine moves";
  const double place_mm = machine.position_mm();
  bench.clock.sleep(5);
  if (!homing && machine.position_mm() != place_mm) return "the machine moved after the run";
  if (machine.moved_unhomed()) return "the machine was moved without a home";
  if (machine.disobeyed_s())
    return fmt::format("a stop was due, and at {:.3f} s the machine moved", *machine.disobeyed_s());
  if (outcome.finished) {
    if (std::abs(place_mm - dip.start_mm) > kStep_mm) return "it says done and is elsewhere";
    return "";
  }
  if (outcome.message.size() < 20) return "no clear message: '" + outcome.message + "'";
  if (confirmed && outcome.rest->place_known &&
      std::abs(outcome.rest->position_mm - place_mm) > kStep_mm)
    return fmt::format("it says it stands at {:.4f}, and stands at {:.4f}",
                       outcome.rest->position_mm, place_mm);
  if (outcome.rest && !confirmed && !outcome.rest->homing &&
      std::copysign(place_mm - outcome.rest->farthest_mm,
                    (place_mm - outcome.rest->farthest_mm) *
                        (outcome.rest->farthest_mm - outcome.rest->position_mm)) > kStep_mm)
    return fmt::format("it went to {:.4f}, beyond the promised {:.4f}", place_mm,
                       outcome.rest->farthest_mm);
  return "";
}

std::string random_faults(Machine machine, unsigned seed, std::string& story) {
  VirtualBench bench(machine, seed);
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  story = fmt::format("seed {}: ", seed);
  const int count = std::uniform_int_distribution<int>(1, 3)(random);
  for (int i = 0; i < count; ++i) {
    Fault fault{static_cast<FaultKind>(std::uniform_int_distribution<int>(0, 7)(random)),
                between(0, 28), between(0.02, 1), between(0.05, 20)};
    if (fault.kind == FaultKind::kSilence) fault.lasts_s = 1e9;
    story += fmt::format("{} ({:.2f}) at {:.3f} s for {:.2f} s; ", name(fault.kind), fault.value,
                         fault.at_s, fault.lasts_s);
    bench.emulator->add(fault);
    if (makes_stop_due(fault.kind, fault.value) &&
        (fault.kind != FaultKind::kSlowReplies || fault.lasts_s > 2))
      bench.clock.at(fault.at_s, [&bench, fault] {
        if (bench.emulator->homing() && leaves_homing_alone(fault.kind)) return;
        bench.emulator->stop_due(bench.clock.now_s() + kLongestStop_s);
      });
  }
  if (between(0, 1) < 0.4) {
    const double at_s = between(0, 28);
    const bool twice = between(0, 1) < 0.5;
    story += fmt::format("Ctrl-C at {:.3f} s{}; ", at_s, twice ? ", and again" : "");
    bench.clock.at(at_s, [&bench] {
      bench.context.cancel();
      if (!bench.emulator->homing()) bench.emulator->stop_due(bench.clock.now_s() + kLongestStop_s);
    });
    if (twice) bench.clock.at(at_s + between(0, 0.4), [&bench] { bench.context.cancel(); });
  }
  const ShortDip dip;
  const Outcome outcome = run_dip(bench, dip);
  story += outcome.finished ? "finished" : outcome.message;
  return broken_promise(bench, outcome, dip);
}

}  // namespace hydrodip
