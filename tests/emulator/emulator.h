// A machine at the other end of a pseudo-terminal, with faults on demand. It lives in the time that
// it is told (advance), so that a test runs a dip in a moment and a person in real time.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "axis.h"

namespace hydrodip {

enum class FaultKind {
  kGarbleReplies,   // value: probability per reply
  kGarbleCommands,  // value: probability per command
  kSlowReplies,     // value: delay in s
  kSilence,         // the cable carries nothing any more
  kUnplug,          // the port vanishes
  kStall,           // the motor is blocked, and the machine notices
  kOverheat,        // a warning flag, though the motor runs on
  kPowerCut,        // off and on again: home is forgotten
  kBlink,           // the same in no time and without a word
  kSlow,            // value: share of the speed that is lost, 0 to 1
  kSlip,            // value: mm that the motor falls back, if it moves
  kSag,             // value: mm that the motor gives way towards more, if it stands
  kStick,           // the motor is blocked, and the machine says that it moves
  kShortTravel,     // value: mm that the machine says it can travel further, either way
};

struct Fault {
  FaultKind kind;
  double at_s = 0;
  double value = 0;
  double lasts_s = 1e9;
};

class Emulator {
 public:
  explicit Emulator(unsigned seed);
  virtual ~Emulator();
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  const std::string& port() const { return port_; }
  int descriptor() const { return master_; }
  // Where it was left when it was switched off.
  void stand_at(double mm);
  void add(const Fault& fault) { faults_.push_back(fault); }

  // Lets the machine live until then, in steps of a millisecond.
  void advance(double now_s);
  double now_s() const { return now_s_; }

  // Bytes taken from and put on the wire, so far.
  std::size_t bytes_read() const { return bytes_read_; }
  std::size_t bytes_written() const { return bytes_written_; }
  void read_wire();

  // The machine must stand still from then on; the first such time counts.
  void stop_due(double at_s);
  // When it moved although it should not have; nothing: never.
  std::optional<double> disobeyed_s() const { return disobeyed_s_; }
  // A movement other than homing was begun without a home, longer after losing it than a computer
  // needs to hear of it.
  bool moved_unhomed() const { return moved_unhomed_; }

  bool moving() const { return axis_.moving(); }
  bool homing() const { return homing_; }
  bool homed() const { return homed_; }
  // Where it truly is, from its home; without a home it counts from somewhere else.
  double position_mm() const { return axis_.position * step_mm_; }
  // When it last began to move, for whatever reason; 0: never.
  double last_start_s() const { return last_start_s_; }
  // Mean speed between two places during the last passage down, mm/min; for the test of constancy.
  double measured_speed_mm_per_min(double from_mm, double to_mm) const;
  bool unplugged() const { return master_ < 0; }
  // Whether a fault of that kind strikes it, now or ever, and the greatest value of those.
  bool ever(FaultKind kind) const;
  double worst(FaultKind kind) const;

 protected:
  virtual void handle(const std::string& line) = 0;
  virtual void tick() {}
  virtual void on_stall() = 0;
  virtual void on_overheat() = 0;
  virtual void on_power_cut();
  virtual bool ends_line(char c) const { return c == '\r' || c == '\n'; }

  void reply(const std::string& line);
  void begin_homing();
  void begin_move();
  // Of what the machine believes of itself.
  double count() const { return axis_.position - origin_; }
  void aim_at(double count) { axis_.target = std::round(count + origin_); }
  void count_from_here() { origin_ = axis_.position; }
  double strength(FaultKind kind) const;

  Axis axis_;  // in steps
  double step_mm_ = 1;
  bool homed_ = false, homing_ = false;
  double now_s_ = 0;
  bool moved_unhomed_ = false;
  std::mt19937 random_;

 private:
  struct Outgoing {
    double due_s;
    std::string bytes;
  };

  bool active(const Fault& fault) const {
    return now_s_ >= fault.at_s && now_s_ < fault.at_s + fault.lasts_s;
  }
  bool chance(double probability);
  void garble(std::string& bytes);
  void strike();
  bool mute() const { return strength(FaultKind::kSilence) > 0 || now_s_ < awake_s_; }
  void unplug();
  void deliver();
  void move();
  void step_axis(double pace);
  void watch();

  int master_ = -1;
  int slave_ = -1;  // kept open, so that the port outlives those who open it
  std::string port_;
  std::string line_;
  std::vector<Fault> faults_;
  std::vector<bool> struck_;
  double origin_ = 0;  // in steps
  double lost_home_s_ = -1e9;
  double awake_s_ = 0;  // after a power cut the machine first has to start
  std::deque<Outgoing> outgoing_;
  std::size_t bytes_read_ = 0, bytes_written_ = 0;
  std::optional<double> due_s_, disobeyed_s_;
  double last_start_s_ = 0;
  bool was_moving_ = false;
  struct Place {
    double time_s, mm;
  };
  std::vector<Place> history_;
};

// Zaber A-LST0750B-E01 as the ASCII protocol manual describes it.
std::unique_ptr<Emulator> zaber_emulator(unsigned seed = 1, bool homed = false);
// How a printer is built, and what others have left it in.
struct MarlinHabits {
  double home_mm = 0;           // where it counts its home: 0 or, if it counts upward to it, 200
  double home_offset_mm = 0;    // M206: what it shows over what its steps come to
  double feed_percent = 100;    // M220
  bool inches = false;          // G20
  bool wants_xy_first = false;  // Z_SAFE_HOMING: does not home Z alone, and says ok
};
// A printer under Marlin 2 with 200 mm of Z.
std::unique_ptr<Emulator> marlin_emulator(unsigned seed = 1, const MarlinHabits& habits = {});

}  // namespace hydrodip
