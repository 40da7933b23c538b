#include "session.h"

#include <fmt/format.h>

#include <array>
#include <random>

namespace hydrodip {
namespace {

constexpr double kStep_mm = 0.0025;  // the coarser machine's
constexpr double kLook_s = 0.01;
constexpr double kStuck_s = 1;

// What the storm draws from.
constexpr std::array<FaultKind, 12> kDrawn = {
    FaultKind::kGarbleReplies, FaultKind::kGarbleCommands, FaultKind::kSlowReplies,
    FaultKind::kSilence,       FaultKind::kUnplug,         FaultKind::kStall,
    FaultKind::kOverheat,      FaultKind::kPowerCut,       FaultKind::kBlink,
    FaultKind::kSlow,          FaultKind::kSlip,           FaultKind::kStick};

const char* name(FaultKind kind) {
  switch (kind) {
    case FaultKind::kGarbleReplies:
      return "garbled replies";
    case FaultKind::kGarbleCommands:
      return "garbled commands";
    case FaultKind::kSlowReplies:
      return "slow replies";
    case FaultKind::kSilence:
      return "silence";
    case FaultKind::kUnplug:
      return "unplugged";
    case FaultKind::kStall:
      return "stall";
    case FaultKind::kOverheat:
      return "overheated";
    case FaultKind::kPowerCut:
      return "power cut";
    case FaultKind::kBlink:
      return "power blinked";
    case FaultKind::kSlow:
      return "runs slow";
    case FaultKind::kSlip:
      return "slipped";
    case FaultKind::kSag:
      return "sagged";
    case FaultKind::kStick:
      return "stuck";
    case FaultKind::kShortTravel:
      return "short travel";
  }
  return "";
}

// Homing is the stage's own movement: without a link it runs to its end.
bool leaves_homing_alone(FaultKind kind) {
  return kind == FaultKind::kSilence || kind == FaultKind::kUnplug ||
         kind == FaultKind::kSlowReplies;
}

bool ends_everything(FaultKind kind) {
  return kind == FaultKind::kSilence || kind == FaultKind::kUnplug || kind == FaultKind::kOverheat;
}

// The rest is for the referee to see.
bool ends_movement(const Fault& fault) {
  return ends_everything(fault.kind) || fault.kind == FaultKind::kStall ||
         fault.kind == FaultKind::kPowerCut || fault.kind == FaultKind::kBlink ||
         (fault.kind == FaultKind::kSlowReplies && fault.value > kReplyTimeout_s &&
          fault.lasts_s > 2);
}

bool loses_link(const Emulator& machine) {
  return machine.ever(FaultKind::kSilence) || machine.ever(FaultKind::kUnplug) ||
         machine.ever(FaultKind::kSlowReplies);
}

// Without a link a stage runs to the end of its leash, at whatever pace it has.
double longest_stop_s(const Emulator& machine) {
  const double pace = 1 - std::min(machine.worst(FaultKind::kSlow), 0.99);
  return kLongestStop_s / (loses_link(machine) ? pace : 1);
}

void tell_what_is_due(const Fault& fault, Emulator& machine, VirtualClock& clock) {
  if (machine.homing() && leaves_homing_alone(fault.kind)) return;
  if (ends_everything(fault.kind) || (machine.moving() && ends_movement(fault)))
    machine.stop_due(clock.now_s() + longest_stop_s(machine));
}

}  // namespace

void Referee::start() {
  look();
  clock_.at(clock_.now_s() + kLook_s, [this] { start(); });
}

void Referee::movement(const std::string& phase, double goal_mm, double steady_mm_per_min) {
  if (phase == phase_) return;
  phase_ = phase;
  start_s_ = moved_s_ = clock_.now_s();
  start_mm_ = place_mm_ = machine_.position_mm();
  goal_mm_ = goal_mm;
  mm_per_s_ = steady_mm_per_min / 60;
}

void Referee::look() {
  const double now_s = clock_.now_s(), place_mm = machine_.position_mm();
  if (place_mm != place_mm_) moved_s_ = now_s;
  place_mm_ = place_mm;
  if (phase_.empty() || std::abs(place_mm - goal_mm_) <= kStep_mm) return;
  const double way_mm = goal_mm_ - start_mm_;
  const double done_mm = std::min(mm_per_s_ * (now_s - start_s_), std::abs(way_mm));
  const double lag_mm = std::abs(start_mm_ + std::copysign(done_mm, way_mm) - place_mm);
  const bool steady = mm_per_s_ > 0;
  if (now_s - moved_s_ > kStuck_s || (steady && lag_mm > allowed_lag_mm(mm_per_s_)))
    machine_.stop_due(now_s + longest_stop_s(machine_));
}

bool runs_out_later(const Emulator& machine, const std::string& message) {
  return loses_link(machine) && machine.ever(FaultKind::kStick) &&
         message.find("could not be asked") != std::string::npos;
}

std::string broken_promise(VirtualBench& bench, const Outcome& outcome, const ShortDip& dip) {
  Emulator& machine = *bench.emulator;
  const bool confirmed = outcome.rest && outcome.rest->confirmed;
  const bool homing = outcome.rest && outcome.rest->homing && !confirmed;
  const bool later = runs_out_later(machine, outcome.message);
  if (later) bench.clock.sleep(kLongestFault_s);
  if (machine.moving() && !homing) return "the run is over and the machine moves";
  const double place_mm = machine.position_mm();
  bench.clock.sleep(5);
  if (!homing && machine.position_mm() != place_mm) return "the machine moved after the run";
  if (machine.moved_unhomed()) return "the machine was moved without a home";
  if (machine.disobeyed_s() && !later)
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

std::string draw_faults(unsigned seed, double until_s, Emulator& machine, VirtualClock& clock,
                        const RunContext& context) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::string story = fmt::format("seed {}: ", seed);
  const int count = std::uniform_int_distribution<int>(1, 3)(random);
  for (int i = 0; i < count; ++i) {
    Fault fault{kDrawn[std::uniform_int_distribution<std::size_t>(0, kDrawn.size() - 1)(random)],
                between(0, until_s), between(0.02, 1), between(0.05, kLongestFault_s)};
    if (fault.kind == FaultKind::kSilence) fault.lasts_s = 1e9;
    if (fault.kind == FaultKind::kSlip) fault.value *= 10;
    story += fmt::format("{} ({:.2f}) at {:.3f} s for {:.2f} s; ", name(fault.kind), fault.value,
                         fault.at_s, fault.lasts_s);
    machine.add(fault);
    clock.at(fault.at_s, [&machine, &clock, fault] { tell_what_is_due(fault, machine, clock); });
  }
  if (between(0, 1) < 0.4) {
    const double at_s = between(0, until_s);
    const bool twice = between(0, 1) < 0.5;
    story += fmt::format("Ctrl-C at {:.3f} s{}; ", at_s, twice ? ", and again" : "");
    clock.at(at_s, [&machine, &clock, &context] {
      context.cancel();
      if (!machine.homing()) machine.stop_due(clock.now_s() + longest_stop_s(machine));
    });
    if (twice) clock.at(at_s + between(0, 0.4), [&context] { context.cancel(); });
  }
  return story;
}

std::string random_faults(Machine machine, unsigned seed, std::string& story) {
  VirtualBench bench(machine, seed);
  story = draw_faults(seed, 28, *bench.emulator, bench.clock, bench.context);
  const ShortDip dip;
  Referee referee(*bench.emulator, bench.clock);
  referee.start();
  const Outcome outcome = run_dip(bench, dip, [&](const TracePoint& point) {
    if (point.phase == "dip")
      referee.movement(point.phase, dip.bottom_mm, dip.mm_per_min);
    else if (point.phase == "approach" || point.phase == "retract")
      referee.movement(point.phase, dip.start_mm, 0);
    else
      referee.standstill();
  });
  story += outcome.finished ? "finished" : outcome.message;
  return broken_promise(bench, outcome, dip);
}

}  // namespace hydrodip
