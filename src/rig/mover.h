// Moves a stage so that it stops whatever happens.
//
// A serial link that breaks cannot carry a stop any more. So the stage is never sent all the way at
// once: its target stays only kLeash_s of travel ahead and is moved on several times a second. When
// the program, the computer or the cable dies, the stage runs out of leash and stands still by
// itself. Homing alone is a movement of the stage's own, away from the water, that no leash holds.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/context.h"
#include "rig/stage.h"
#include "rig/trace.h"

namespace hydrodip {

inline constexpr double kLeash_s = 0.6;
// From whatever makes a stop due (Ctrl-C, a lost link, a warning flag) to standstill, at the most.
inline constexpr double kLongestStop_s = 1.5;
// A steady movement is broken off when the stage is farther than this from where its speed should
// have brought it: it has slipped, or is not the stage that it says it is. 0 mm/s: standing still.
inline double allowed_lag_mm(double mm_per_s) { return 1 + 0.6 * mm_per_s; }

// How a movement that was broken off ended.
struct Rest {
  bool place_known = true;  // false: it stands still, but has forgotten where
  bool confirmed = false;   // the stage itself said that it stands still
  double position_mm = 0;   // then; else where it last said it was, while it knew
  double farthest_mm = 0;   // not confirmed: it cannot have got further than this
  bool homing = false;      // it was homing; farthest_mm means nothing
  std::string sentence() const;
};

class Mover {
 public:
  // Connects. Until allow_motion(), nothing moves; until the stage is homed, nothing but homing.
  Mover(Stage& stage, Clock& clock, const RunContext& context);

  const StageIdentity& identity() const { return identity_; }
  StageState state();
  bool is_within_limits(double position_mm) const;
  // Throws StageError for a place beyond the stage's travel.
  void require_within_limits(double position_mm) const;
  // The operator has said yes.
  void allow_motion() { allowed_ = true; }

  // These return when the stage stands still at the end of the movement. On Ctrl-C, a warning flag,
  // a lost or garbled link, a lost home, a lag, a stage that is stuck or takes twice as long as
  // planned, they stop the stage (slowing down; at once on a second Ctrl-C),
  // make sure that it stands still as far as that can be known, and throw Cancelled, LinkError or
  // StageError with what happened and how the stage ended; last_rest() has the latter.
  // Throws StageError without moving for a target beyond the stage's limits.
  void home();
  // Steady: the speed matters, so a computer that comes too late is an error as well.
  void move_to(const std::string& phase, double position_mm, double mm_per_min, bool steady);
  // Stands still; a stage that leaves its place is an error.
  void dwell(const std::string& phase, double seconds);

  const std::optional<Rest>& last_rest() const { return last_rest_; }
  const Trace& trace() const { return trace_; }
  // Called with every new point.
  void on_point(std::function<void(const TracePoint&)> sink) { sink_ = std::move(sink); }

 private:
  struct Way;
  void require_permission() const;
  void guarded(const std::string& phase, bool homing, const std::function<void()>& movement);
  StageState look();
  void follow(const Way& way);
  void check(const StageState& state, const Way& way, double elapsed_s) const;
  void check_lag(const StageState& state, const Way& way, double elapsed_s) const;
  void check_progress(const Way& way, double elapsed_s, double still_s) const;
  static void require_sound(const StageState& state);
  void record(const std::string& phase, double commanded_mm, double reported_mm);
  Rest bring_to_rest(bool homing);
  void cancel_point() const;

  Stage& stage_;
  Clock& clock_;
  const RunContext& context_;
  StageIdentity identity_;
  bool allowed_ = false;
  double last_position_mm_ = 0;
  double leash_end_mm_ = 0;
  std::optional<double> trace_start_s_;
  std::optional<Rest> last_rest_;
  Trace trace_;
  std::function<void(const TracePoint&)> sink_;
};

}  // namespace hydrodip
