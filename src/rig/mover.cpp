#include "rig/mover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hydrodip {
namespace {

constexpr double kCycle_s = 0.08;
constexpr double kRestPoll_s = 0.05;
// How long stopping is tried before it counts as not confirmed.
constexpr double kRestTimeout_s = 4;
constexpr double kOldAnswers_s = 3;
constexpr double kHomingTimeout_s = 300;
// A movement may take this many times as long as planned, and this long on top.
constexpr double kDeadlineFactor = 2, kDeadline_s = 5;
// A stage that is under way and stays where it is for that long is stuck. At a crawl it still has
// time for a few steps.
constexpr double kStuck_s = 1, kStuckSteps = 4;
// Short leashes still span a few steps.
constexpr double kLeashSteps = 8;

// The stop of a movement that was under way: why, and how it ended.
std::string with_rest(const std::string& phase, const std::string& why, const Rest& rest) {
  const bool ended = why.ends_with('.') || why.ends_with('?') || why.ends_with('!');
  return fmt::format("{}: {}{} {}", phase, why, ended ? "" : ".", rest.sentence());
}

}  // namespace

std::string Rest::sentence() const {
  if (confirmed && !place_known)
    return "The stage stands still and no longer knows where: home it before anything else.";
  if (confirmed) return fmt::format("The stage stands still at {:.3f} mm.", position_mm);
  if (homing)
    return "Whether the stage stands still is not known: it may still be homing. Keep clear, or "
           "take its power away.";
  return fmt::format(
      "The stage could not be asked; it was last seen at {:.3f} mm and ends by itself at {:.3f} mm "
      "at the latest. Look before you touch it.",
      position_mm, farthest_mm);
}

// One movement from the place where the stage stands.
struct Mover::Way {
  std::string phase;
  double start_mm = 0, end_mm = 0;
  double mm_per_s = 0;
  double step_mm = 0;
  bool steady = false;

  double length_mm() const { return std::abs(end_mm - start_mm); }
  double planned_s() const { return length_mm() / mm_per_s; }
  double deadline_s() const { return kDeadlineFactor * planned_s() + kDeadline_s; }
  double stuck_s() const { return std::max(kStuck_s, kStuckSteps * step_mm / mm_per_s); }
  double direction() const { return end_mm >= start_mm ? 1 : -1; }
  double leash_mm() const { return std::max(mm_per_s * kLeash_s, kLeashSteps * step_mm); }
  double leash_end_mm(double position_mm) const {
    const double ahead = position_mm + direction() * leash_mm();
    return direction() > 0 ? std::min(ahead, end_mm) : std::max(ahead, end_mm);
  }
  double commanded_mm(double elapsed_s) const {
    return start_mm + direction() * std::min(mm_per_s * elapsed_s, length_mm());
  }
};

Mover::Mover(Stage& stage, Clock& clock, const RunContext& context)
    : stage_(stage), clock_(clock), context_(context), identity_(stage.connect()) {
  context.expect_second_cancel();
}

StageState Mover::state() { return stage_.state(); }

// A stage that has forgotten where it is counts from somewhere else.
StageState Mover::look() {
  StageState state = stage_.state();
  if (state.position_known) last_position_mm_ = state.position_mm;
  return state;
}

void Mover::home() {
  require_permission();
  guarded("homing", true, [&] {
    cancel_point();
    stage_.acknowledge();
    const StageState before = stage_.state();
    if (!before.fault.empty()) throw StageError(before.fault);
    stage_.start_homing();
    const double deadline_s = clock_.now_s() + kHomingTimeout_s;
    for (;;) {
      clock_.sleep(kCycle_s);
      cancel_point();
      const StageState state = look();
      record("homing", state.position_mm, state.position_mm);
      if (!state.fault.empty()) throw StageError(state.fault);
      if (!state.moving && state.homed) return;
      if (!state.moving) throw StageError("the stage stopped before it reached its home");
      if (clock_.now_s() > deadline_s) throw StageError("the stage does not find its home");
    }
  });
}

void Mover::move_to(const std::string& phase, double position_mm, double mm_per_min, bool steady) {
  require_permission();
  require_within_limits(position_mm);
  guarded(phase, false, [&] {
    cancel_point();
    const StageState state = look();
    if (!state.fault.empty()) throw StageError(state.fault);
    if (!state.homed) throw StageError("the stage is not homed, so it does not know where it is");
    if (state.moving) throw StageError("the stage is moving already");
    stage_.set_speed(mm_per_min);
    follow({phase, state.position_mm, position_mm, mm_per_min / 60, identity_.step_mm, steady});
  });
}

void Mover::follow(const Way& way) {
  const double start_s = clock_.now_s();
  leash_end_mm_ = way.start_mm;
  double moved_s = start_s;  // when its place last changed
  record(way.phase, way.start_mm, way.start_mm);
  for (;;) {
    cancel_point();
    leash_end_mm_ = way.leash_end_mm(last_position_mm_);
    stage_.aim(leash_end_mm_);
    clock_.sleep(kCycle_s);
    cancel_point();
    const double before_mm = last_position_mm_;
    const StageState state = look();
    const double now_s = clock_.now_s();
    record(way.phase, way.commanded_mm(now_s - start_s), state.position_mm);
    check(state, way, now_s - start_s);
    if (!state.moving && leash_end_mm_ == way.end_mm) return;
    if (std::abs(last_position_mm_ - before_mm) > 0.5 * way.step_mm) moved_s = now_s;
    check_progress(way, now_s - start_s, now_s - moved_s);
  }
}

void Mover::check(const StageState& state, const Way& way, double elapsed_s) const {
  require_sound(state);
  if (way.steady) check_lag(state, way, elapsed_s);
  const bool at_leash_end = std::abs(state.position_mm - leash_end_mm_) <= way.step_mm;
  if (!state.moving && !at_leash_end)
    throw StageError(fmt::format(
        "the stage stopped {:.3f} mm before its goal: something is in its way, or its travel ends "
        "earlier than it says",
        std::abs(state.position_mm - way.end_mm)));
  if (way.steady && at_leash_end && leash_end_mm_ != way.end_mm)
    throw StageError(
        "the stage had to wait, for the computer or the link was too slow to keep the speed");
}

void Mover::check_lag(const StageState& state, const Way& way, double elapsed_s) const {
  const double lag_mm = way.direction() * (way.commanded_mm(elapsed_s) - state.position_mm);
  if (std::abs(lag_mm) <= allowed_lag_mm(way.mm_per_s)) return;
  throw StageError(fmt::format(
      "the stage is {} by {:.1f} mm: it slips, runs at a speed of its own, or answers too late",
      lag_mm > 0 ? "behind" : "ahead", std::abs(lag_mm)));
}

void Mover::check_progress(const Way& way, double elapsed_s, double still_s) const {
  const double left_mm = std::abs(way.end_mm - last_position_mm_);
  if (still_s >= way.stuck_s())
    throw StageError(
        fmt::format("the stage is stuck {:.1f} mm before its goal: something is in its way, or its "
                    "travel ends earlier than it says",
                    left_mm));
  if (elapsed_s > way.deadline_s())
    throw StageError(fmt::format(
        "the stage is still {:.1f} mm from its goal after {:.0f} s, where {:.0f} s were planned",
        left_mm, elapsed_s, way.planned_s()));
}

void Mover::require_sound(const StageState& state) {
  if (!state.fault.empty()) throw StageError(state.fault);
  if (!state.homed) throw StageError("the stage has forgotten its home: was its power cut?");
}

void Mover::dwell(const std::string& phase, double seconds) {
  guarded(phase, false, [&] {
    const double end_s = clock_.now_s() + seconds;
    const double place_mm = last_position_mm_;
    leash_end_mm_ = place_mm;
    for (;;) {
      cancel_point();
      const StageState state = look();
      record(phase, place_mm, state.position_mm);
      require_sound(state);
      const double off_mm = std::abs(state.position_mm - place_mm);
      if (off_mm > allowed_lag_mm(0))
        throw StageError(fmt::format("the stage has left its place by {:.1f} mm", off_mm));
      const double left_s = end_s - clock_.now_s();
      if (left_s <= 0) return;
      clock_.sleep(std::min(left_s, 0.5));
    }
  });
}

void Mover::require_permission() const {
  if (!allowed_) throw std::logic_error("a stage was to move without permission");
}

bool Mover::is_within_limits(double position_mm) const {
  const double slack_mm = identity_.step_mm;
  return position_mm >= identity_.min_mm - slack_mm && position_mm <= identity_.max_mm + slack_mm;
}

void Mover::require_within_limits(double position_mm) const {
  if (is_within_limits(position_mm)) return;
  throw StageError(fmt::format(
      "{:.2f} mm is beyond the stage's travel of {:.2f} to {:.2f} mm: hang the object higher or "
      "lower, or dip less of it",
      position_mm, identity_.min_mm, identity_.max_mm));
}

void Mover::cancel_point() const {
  if (context_.cancelled()) throw Cancelled();
}

void Mover::guarded(const std::string& phase, bool homing, const std::function<void()>& movement) {
  last_rest_.reset();
  try {
    movement();
  } catch (const Cancelled&) {
    last_rest_ = bring_to_rest(homing);
    throw Cancelled(with_rest(phase, "stopped by you", *last_rest_));
  } catch (const LinkError& error) {
    last_rest_ = bring_to_rest(homing);
    throw LinkError(with_rest(phase, error.what(), *last_rest_));
  } catch (const StageError& error) {
    last_rest_ = bring_to_rest(homing);
    throw StageError(with_rest(phase, error.what(), *last_rest_));
  }
}

// Nothing here may throw or give up early: it is the way out of everything else.
Rest Mover::bring_to_rest(bool homing) {
  Rest rest;
  rest.position_mm = last_position_mm_;
  rest.farthest_mm =
      leash_end_mm_ + (leash_end_mm_ < last_position_mm_ ? -1 : 1) * identity_.unsure_mm;
  rest.homing = homing;
  const double start_s = clock_.now_s();
  // Over a bad link, what arrives may be an answer of long ago.
  bool link_bad = false, stopped = false, halted = false;
  while (clock_.now_s() < start_s + kRestTimeout_s) {
    try {
      const bool urgent = context_.cancel_requests() > 1;
      if (urgent && !halted) {
        stage_.halt();
        stopped = halted = true;
      } else if (!stopped) {
        stage_.stop();
        stopped = true;
      }
      const StageState state = look();
      rest.position_mm = last_position_mm_;
      rest.place_known = state.position_known;
      rest.confirmed = !state.moving;
      if (rest.confirmed && (!link_bad || clock_.now_s() > start_s + kOldAnswers_s)) return rest;
    } catch (const StageError&) {
      link_bad = true;
      rest.confirmed = stopped = halted = false;  // again
    }
    clock_.sleep(kRestPoll_s);
  }
  return rest;
}

void Mover::record(const std::string& phase, double commanded_mm, double reported_mm) {
  const double now_s = clock_.now_s();
  if (!trace_start_s_) trace_start_s_ = now_s;
  trace_.push_back({phase, now_s - *trace_start_s_, commanded_mm, reported_mm});
  if (sink_) sink_(trace_.back());
}

}  // namespace hydrodip
