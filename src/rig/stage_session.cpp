#include "rig/stage_session.h"

#include <fmt/format.h>

#include <cmath>

#include "base/parse_double.h"

namespace hydrodip {
namespace {

constexpr double kShowEvery_s = 0.5;
constexpr double kLongestJog_mm = 100;

std::unique_ptr<Link> open_link(const StageOptions& options, Bench& bench) {
  if (options.port.empty())
    throw InputError(
        "name the stage's port with --port, as in --port /dev/ttyUSB0; 'hydrodip rig stage find' "
        "lists them");
  return bench.open(options);
}

std::optional<double> parse_mm(const std::string& text) {
  const char* first = text.data() + (text.starts_with("+") ? 1 : 0);
  double value = 0;
  const auto [end, error] = parse_double(first, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

}  // namespace

StageSession::StageSession(const StageOptions& options, Bench& bench, RunRecord* record,
                           const RunContext& context)
    : options_(options),
      bench_(bench),
      record_(record),
      link_(open_link(options, bench)),
      stage_(make_stage(*link_, bench.clock, options)),
      mover_(*stage_, bench.clock, context) {
  mover_.on_point([this](const TracePoint& point) { show(point); });
  note("stage connected", {{"name", mover_.identity().name},
                           {"port", options.port},
                           {"min_mm", mover_.identity().min_mm},
                           {"max_mm", mover_.identity().max_mm}});
}

std::string StageSession::describe() const {
  const StageIdentity& identity = mover_.identity();
  return fmt::format("{}: travel {:.1f} to {:.1f} mm in steps of {:.5f} mm", identity.name,
                     identity.min_mm, identity.max_mm, identity.step_mm);
}

std::string StageSession::describe_state() {
  const StageState state = mover_.state();
  return fmt::format(
      "at {:.3f} mm, {}, {}{}", state.position_mm, state.homed ? "homed" : "not homed",
      state.moving ? "moving" : "standing still", state.fault.empty() ? "" : "; " + state.fault);
}

double StageSession::position_mm() { return mover_.state().position_mm; }

void StageSession::require_yes(const std::string& question) {
  if (bench_.yes_given) return mover_.allow_motion();
  for (;;) {
    const std::string answer = bench_.person.ask(question + " Type yes: ");
    note("asked before moving", {{"question", question}, {"answer", answer}});
    if (answer == "yes") return mover_.allow_motion();
    if (answer == "no") throw Cancelled("not moved: you said no");
    bench_.person.say("yes or no, in full.");
  }
}

void StageSession::ensure_home(bool always) {
  if (!always && mover_.state().homed) return;
  require_yes("The stage will now move to its home. Is its way free, and are your hands off?");
  note("homing", {});
  mover_.home();
  note("homed", {{"position_mm", position_mm()}});
  bench_.person.say("The stage is at home.");
}

double StageSession::jogged_mm(double down_mm) {
  return position_mm() + (options_.down == StageDown::kPlus ? down_mm : -down_mm);
}

void StageSession::require_jog(double down_mm) {
  const double to_mm = jogged_mm(down_mm);
  const StageIdentity& stage = mover_.identity();
  if (!mover_.is_within_limits(to_mm))
    throw InputError(
        fmt::format("{:+g} mm from {:.2f} mm leads to {:.2f} mm, beyond the stage's travel of "
                    "{:.2f} to {:.2f} mm: move it by less",
                    down_mm, position_mm(), to_mm, stage.min_mm, stage.max_mm));
  if (is_too_low(to_mm))
    throw InputError(fmt::format(
        "{:+g} mm leads to {:.2f} mm, lower than stage.lowest_mm = {:g} allows: move it by less",
        down_mm, to_mm, options_.lowest_mm));
}

void StageSession::jog(double down_mm) {
  require_jog(down_mm);
  move("jog", jogged_mm(down_mm), options_.travel_mm_per_min / 2, false);
}

double StageSession::find_water_level() {
  bench_.person.say(
      "Bring the object's lowest point to where it just touches the water. No film must be on it.\n"
      "  20     lowers it by 20 mm        -5     lifts it by 5 mm        here   it touches");
  for (;;) {
    const std::string answer =
        bench_.person.ask(fmt::format("{:.2f} mm; mm to lower, or here: ", position_mm()));
    if (answer == "here") break;
    const auto down_mm = parse_mm(answer);
    if (!down_mm || std::abs(*down_mm) > kLongestJog_mm) {
      bench_.person.say(fmt::format("A number of mm up to {:g}, or here.", kLongestJog_mm));
      continue;
    }
    try {
      jog(*down_mm);
    } catch (const LinkError&) {
      throw;
    } catch (const InputError& error) {
      bench_.person.say(error.what());  // beyond its travel: ask again
    } catch (const StageError& error) {
      bench_.person.say(error.what());
      if (!mover_.state().fault.empty()) throw;
    }
  }
  const double level_mm = position_mm();
  note("water level", {{"water_mm", level_mm}});
  return level_mm;
}

void StageSession::lift_clear(double water_mm) {
  move("lift", stage_position_mm(options_, water_mm, options_.clearance_mm),
       options_.travel_mm_per_min, false);
}

void StageSession::perform(const RigJob& job, double water_mm, const std::string& phase) {
  for (const PlannedMove& planned : plan_dip(job)) {
    if (planned.phase != phase) continue;
    if (!(planned.mm_per_min > 0)) {
      note(phase, {{"seconds", planned.seconds}});
      mover_.dwell(phase, planned.seconds);
      continue;
    }
    move(phase, stage_position_mm(options_, water_mm, planned.to_height_mm), planned.mm_per_min,
         phase == "dip");
  }
}

void StageSession::move(const std::string& phase, double position_mm, double mm_per_min,
                        bool steady) {
  require_above_lowest(phase, position_mm);
  note("move", {{"phase", phase}, {"to_mm", position_mm}, {"mm_per_min", mm_per_min}});
  mover_.move_to(phase, position_mm, mm_per_min, steady);
  LogFields fields = {{"phase", phase}, {"position_mm", this->position_mm()}};
  if (const auto speed = steady ? check_speed(trace(), phase, mm_per_min) : std::nullopt)
    fields.insert(fields.end(), {{"measured_mm_per_min", speed->measured_mm_per_min},
                                 {"speed_error_percent", speed->error_percent()}});
  note("moved", fields);
}

void StageSession::require_reach(double water_mm, const PlannedMove& move) const {
  const double position_mm = stage_position_mm(options_, water_mm, move.to_height_mm);
  require_above_lowest(move.phase, position_mm);
  mover_.require_within_limits(position_mm);
}

bool StageSession::is_too_low(double position_mm) const {
  const bool down_is_plus = options_.down == StageDown::kPlus;
  return options_.lowest_mm > 0 &&
         (down_is_plus ? position_mm > options_.lowest_mm : position_mm < options_.lowest_mm);
}

void StageSession::require_above_lowest(const std::string& phase, double position_mm) const {
  if (is_too_low(position_mm))
    throw StageError(fmt::format("{}: {:.2f} mm is lower than stage.lowest_mm = {:g} allows", phase,
                                 position_mm, options_.lowest_mm));
}

void StageSession::show(const TracePoint& point) {
  if (point.time_s - shown_s_ < kShowEvery_s && point.time_s >= shown_s_) return;
  shown_s_ = point.time_s;
  bench_.person.show(
      fmt::format("{:<8} {:8.2f} mm   (Ctrl-C stops)", point.phase, point.reported_mm));
}

void StageSession::note(const std::string& event, const LogFields& fields) {
  if (record_) record_->note(event, fields);
}

}  // namespace hydrodip
