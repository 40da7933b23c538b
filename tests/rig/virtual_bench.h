// A bench in its own time: the real drivers, over a real pseudo-terminal, to an emulator. Time only
// passes when somebody waits, so a minute's dip takes a moment and always runs the same way.
#pragma once

#include <poll.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "emulator.h"
#include "rig/link.h"
#include "rig/mover.h"

namespace hydrodip {

class VirtualClock : public Clock {
 public:
  explicit VirtualClock(Emulator& emulator) : emulator_(emulator) {}

  double now_s() override { return now_s_; }
  std::string utc() override { return "2026-01-31T12:00:00Z"; }

  bool wait_readable(int descriptor, double seconds) override {
    const double end_s = now_s_ + seconds;
    for (;;) {
      settle();
      if (descriptor >= 0 && readable(descriptor)) return true;
      if (now_s_ >= end_s) return false;
      now_s_ = std::min(end_s, now_s_ + 1e-3);
      while (!events_.empty() && events_.front().first <= now_s_) {
        const auto event = events_.front().second;
        events_.erase(events_.begin());
        event();
      }
    }
  }

  // Calls it at that time; in the order of times.
  void at(double time_s, std::function<void()> event) {
    events_.emplace_back(time_s, std::move(event));
    std::stable_sort(events_.begin(), events_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
  }

  // As when the computer is busy with something else for so long.
  void hiccup(double seconds) { now_s_ += seconds; }

  std::size_t sent = 0, received = 0;  // by our side of the wire

 private:
  // The kernel carries bytes across a pseudo-terminal in its own time: wait for what is on its way.
  void settle() {
    for (int i = 0; i < 1000 && !emulator_.unplugged() && emulator_.bytes_read() < sent; ++i) {
      pollfd wire = {emulator_.descriptor(), POLLIN, 0};
      ::poll(&wire, 1, 1);
      emulator_.read_wire();
    }
    emulator_.advance(now_s_);
  }

  bool readable(int descriptor) {
    const bool due = emulator_.unplugged() || emulator_.bytes_written() > received;
    if (!due) return false;
    pollfd wire = {descriptor, POLLIN, 0};
    if (::poll(&wire, 1, 1000) > 0) return true;
    received = emulator_.bytes_written();  // thrown away when the port was opened
    return false;
  }

  Emulator& emulator_;
  double now_s_ = 0;
  std::vector<std::pair<double, std::function<void()>>> events_;
};

class CountingLink : public Link {
 public:
  CountingLink(std::unique_ptr<Link> link, VirtualClock& clock)
      : link_(std::move(link)), clock_(clock) {}
  void send(const std::string& bytes) override {
    link_->send(bytes);
    clock_.sent += bytes.size();
  }
  std::string receive(double seconds) override {
    const std::string bytes = link_->receive(seconds);
    clock_.received += bytes.size();
    return bytes;
  }

 private:
  std::unique_ptr<Link> link_;
  VirtualClock& clock_;
};

enum class Machine { kZaber, kMarlin };

struct VirtualBench {
  explicit VirtualBench(Machine machine, unsigned seed = 1)
      : VirtualBench(machine == Machine::kZaber ? zaber_emulator(seed) : marlin_emulator(seed),
                     options_of(machine)) {}
  // A printer of that kind.
  explicit VirtualBench(const MarlinHabits& habits, StageDown down = StageDown::kPlus)
      : VirtualBench(marlin_emulator(1, habits), options_of(Machine::kMarlin, down)) {}
  VirtualBench(std::unique_ptr<Emulator> machine, const StageOptions& how)
      : emulator(std::move(machine)),
        clock(*emulator),
        link(open_serial(emulator->port(), 115200, clock), clock),
        options(how),
        stage(make_stage(link, clock, options)) {}

  static StageOptions options_of(Machine machine, StageDown down = StageDown::kPlus) {
    StageOptions options;
    options.down = down;
    if (machine == Machine::kMarlin) options.driver = StageDriver::kMarlin;
    return options;
  }

  std::unique_ptr<Emulator> emulator;
  VirtualClock clock;
  CountingLink link;
  StageOptions options;
  std::unique_ptr<Stage> stage;
  RunContext context;
};

}  // namespace hydrodip
