// A stage with its operator: asks before it moves, tells what happens, writes it down.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rig/mover.h"
#include "rig/rig.h"
#include "rig/run_record.h"

namespace hydrodip {

class StageSession {
 public:
  // Opens the port and connects. `record` may be null.
  StageSession(const StageOptions& options, Bench& bench, RunRecord* record,
               const RunContext& context);

  // Homes the stage unless it is homed, after a yes.
  void ensure_home(bool always = false);
  // What the stage is.
  std::string describe() const;
  StageState state() { return mover_.state(); }
  // "at 12.3 mm, homed, standing still".
  std::string describe_state();
  double position_mm();
  // Throws InputError if the stage cannot go so far from where it stands.
  void require_jog(double down_mm);
  // Positive lowers the object. Throws as require_jog, without moving.
  void jog(double down_mm);
  // Lets the operator bring the object's lowest point to the water; the position there.
  double find_water_level();
  void lift_clear(double water_mm);
  // The plan's movements of that name, one or several: "approach", "dip", "dwell", "retract".
  void perform(const RigJob& job, double water_mm, const std::string& phase);
  // Throws StageError if the stage cannot get where the movement leads.
  void require_reach(double water_mm, const PlannedMove& move) const;
  // Asks until the answer is yes or no, in full; throws Cancelled for a no.
  void require_yes(const std::string& question);

  const Trace& trace() const { return mover_.trace(); }
  const std::optional<Rest>& last_rest() const { return mover_.last_rest(); }

 private:
  void show(const TracePoint& point);
  void move(const std::string& phase, double position_mm, double mm_per_min, bool steady);
  double jogged_mm(double down_mm);
  bool is_too_low(double position_mm) const;
  void require_above_lowest(const std::string& phase, double position_mm) const;
  void note(const std::string& event, const LogFields& fields);

  StageOptions options_;
  Bench& bench_;
  RunRecord* record_;
  std::unique_ptr<Link> link_;
  std::unique_ptr<Stage> stage_;
  Mover mover_;
  double shown_s_ = -1e9;
};

}  // namespace hydrodip
