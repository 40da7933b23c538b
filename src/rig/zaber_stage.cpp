#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "base/parse_double.h"
#include "rig/stage.h"
#include "rig/zaber_message.h"

namespace hydrodip {
namespace {

// The manual's section "Units": a speed is microsteps per second times this.
constexpr double kSpeedUnit = 1.6384;
constexpr int kAttempts = 2;
// Travel that differs by more from the data sheet's comes from another stage, or another screw.
constexpr double kTravelTolerance = 0.05;

class ZaberStage : public Stage {
 public:
  ZaberStage(Link& link, Clock& clock, const StageOptions& options)
      : link_(link), clock_(clock), lines_(link, clock), options_(options) {}

  StageIdentity connect() override {
    lines_.clear();
    exchange("");
    request_checksums();
    StageIdentity identity;
    identity.name =
        fmt::format("Zaber device {}, firmware {}", ask("get deviceid"), ask("get version"));
    identity.step_mm = step_mm();
    identity.min_mm = to_mm(ask_number("get limit.min"));
    identity.max_mm = to_mm(ask_number("get limit.max"));
    check_travel(identity);
    return identity;
  }

  StageState state() override {
    const ZaberReply reply = exchange("get pos");
    StageState state;
    state.position_mm = to_mm(number(reply.data, "get pos"));
    state.moving = reply.busy;
    state.flag = reply.flag;
    state.fault = describe_fault(reply.flag);
    state.homed = state.position_known =
        state.fault.empty() ? !zaber_flag_means_not_homed(reply.flag) : homed_behind_fault();
    return state;
  }

  void acknowledge() override { command("warnings clear"); }
  void start_homing() override { command("home"); }

  void set_speed(double mm_per_min) override {
    command(fmt::format("set maxspeed {}", std::lround(mm_per_min / 60 / step_mm() * kSpeedUnit)));
  }

  void aim(double position_mm) override {
    const ZaberReply reply =
        command(fmt::format("move abs {}", std::lround(position_mm / step_mm())));
    const std::string fault = describe_fault(reply.flag);
    if (!fault.empty()) throw StageError(fault);
    if (zaber_flag_means_not_homed(reply.flag))
      throw StageError("the stage has forgotten its home: was its power cut?");
  }

  void stop() override { command("stop"); }
  void halt() override { command("estop"); }

 private:
  double step_mm() const { return 1e-3 * options_.microstep_um; }
  double to_mm(double microsteps) const { return microsteps * step_mm(); }

  static std::string describe_fault(const std::string& flag) {
    const std::string words = zaber_fault(flag);
    return words.empty() ? "" : fmt::format("{} (warning flag {})", words, flag);
  }

  // Commands may be repeated without harm: places are absolute.
  ZaberReply exchange(const std::string& text) {
    bool damaged = false;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const int id = next_id_;
      next_id_ = (next_id_ + 1) % 100;
      link_.send(zaber_command(options_.address, 0, id, text));
      const double deadline_s = clock_.now_s() + kReplyTimeout_s / kAttempts;
      while (const auto line = lines_.line(deadline_s)) {
        ZaberReply reply;
        const ZaberLine kind = read_zaber_line(*line, checksums_, reply);
        if (kind == ZaberLine::kDamaged) damaged = true;
        // Other numbers are late replies to earlier commands.
        if (kind == ZaberLine::kReply && reply.id == id && reply.address == options_.address)
          return reply;
      }
    }
    if (damaged)
      throw LinkError("what the stage answers is garbled: check cable, plugs and stage.baud");
    throw LinkError(fmt::format(
        "the stage did not answer within {:g} s: check cable, power, stage.baud and stage.address",
        kReplyTimeout_s));
  }

  ZaberReply command(const std::string& text) {
    ZaberReply reply = exchange(text);
    // What was garbled on the way may look like a command that nobody knows.
    if (!reply.accepted && reply.data.starts_with("BAD")) reply = exchange(text);
    if (!reply.accepted)
      throw StageError(fmt::format("the stage refused '{}': {}", text, zaber_refusal(reply.data)));
    return reply;
  }

  std::string ask(const std::string& text) { return command(text).data; }
  double ask_number(const std::string& text) { return number(ask(text), text); }

  static double number(const std::string& text, const std::string& command) {
    double value = 0;
    const auto [end, error] = parse_double(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size()) return value;
    throw StageError(fmt::format(
        "the stage answered '{}' to '{}', where one number was expected: a controller with several "
        "axes is not supported",
        text, command));
  }

  // Replies show one flag, and a fault's hides that home is lost. The list shows all: "02 FS WR".
  bool homed_behind_fault() {
    const ZaberReply reply = exchange("warnings");
    std::istringstream words(reply.data);
    for (std::string flag; words >> flag;)
      if (zaber_flag_means_not_homed(flag)) return false;
    return reply.accepted;
  }

  // Early firmware does not know the setting; replies then come without.
  void request_checksums() { checksums_ = exchange("set comm.checksum 1").accepted; }

  void check_travel(const StageIdentity& identity) const {
    const double travel_mm = identity.max_mm - identity.min_mm;
    if (!(options_.travel_mm > 0)) return;
    if (std::abs(travel_mm / options_.travel_mm - 1) <= kTravelTolerance) return;
    throw StageError(fmt::format(
        "the stage says it travels {:.1f} mm at {:g} um per microstep, but stage.travel_mm is "
        "{:g}: set stage.microstep_um and stage.travel_mm from its data sheet",
        travel_mm, options_.microstep_um, options_.travel_mm));
  }

  Link& link_;
  Clock& clock_;
  LineReader lines_;
  StageOptions options_;
  int next_id_ = 0;
  bool checksums_ = false;
};

}  // namespace

std::unique_ptr<Stage> zaber_stage(Link& link, Clock& clock, const StageOptions& options) {
  return std::make_unique<ZaberStage>(link, clock, options);
}

std::unique_ptr<Stage> make_stage(Link& link, Clock& clock, const StageOptions& options) {
  if (options.driver == StageDriver::kMarlin) return marlin_stage(link, clock, options);
  return zaber_stage(link, clock, options);
}

}  // namespace hydrodip
