// A linear stage, whoever built it. Positions are mm as the stage counts them.
#pragma once

#include <memory>
#include <string>

#include "rig/link.h"
#include "settings/config.h"

namespace hydrodip {

struct StageIdentity {
  std::string name;  // "Zaber device 50081, firmware 6.14"
  double min_mm = 0, max_mm = 0;
  double step_mm = 0;    // smallest movement
  double unsure_mm = 0;  // a link that garbles may send it so much further without anybody seeing
};

struct StageState {
  double position_mm = 0;
  bool position_known = true;  // false: halted, or without a home; position_mm means little
  bool moving = false;
  bool homed = false;
  std::string flag;   // as the stage says it: "WR"; "" for none
  std::string fault;  // why the stage must not go on, in words; "" for none
};

// Every call throws LinkError when the stage does not answer in time and StageError when it
// refuses. Nothing waits for a movement to end.
class Stage {
 public:
  virtual ~Stage() = default;
  // Finds the stage and learns what it is. Call it first.
  virtual StageIdentity connect() = 0;
  virtual StageState state() = 0;
  // The operator has seen to whatever the stage warned of: it may forget it.
  virtual void acknowledge() = 0;
  virtual void start_homing() = 0;
  // Of the movements that are started from here on.
  virtual void set_speed(double mm_per_min) = 0;
  // Goes there and stops. On the way it may be called again with a place further on: the stage
  // then passes the old one without slowing down.
  virtual void aim(double position_mm) = 0;
  virtual void stop() = 0;  // slowing down
  virtual void halt() = 0;  // at once, whatever it costs
};

// The longest that a command may go unanswered, all repetitions included.
inline constexpr double kReplyTimeout_s = 0.3;

std::unique_ptr<Stage> zaber_stage(Link& link, Clock& clock, const StageOptions& options);
std::unique_ptr<Stage> marlin_stage(Link& link, Clock& clock, const StageOptions& options);
std::unique_ptr<Stage> make_stage(Link& link, Clock& clock, const StageOptions& options);

}  // namespace hydrodip
