// Zaber's ASCII protocol from the device's side, written from the manual and not from our driver.
#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "emulator.h"

namespace hydrodip {
namespace {

constexpr double kMicrostep_mm = 0.00049609375;
constexpr long kLimitMax = 1511811;  // 750 mm
constexpr double kSpeedUnit = 1.6384;

int lrc(const std::string& text) {
  int sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  return (0x100 - (sum & 0xFF)) & 0xFF;
}

class ZaberEmulator : public Emulator {
 public:
  ZaberEmulator(unsigned seed, bool homed) : Emulator(seed) {
    step_mm_ = kMicrostep_mm;
    homed_ = homed;
    axis_.position = axis_.target = 200000;
    if (!homed) count_from_here();
    axis_.top_speed = 153600 / kSpeedUnit;
    axis_.acceleration = 205 * 10000 / kSpeedUnit;
    set_speed_ = axis_.top_speed;
  }

 protected:
  void handle(const std::string& raw) override {
    const std::size_t slash = raw.find('/');
    if (slash == std::string::npos) return;
    std::string text = raw.substr(slash + 1);
    const std::size_t colon = text.rfind(':');
    if (colon != std::string::npos) {
      // A wrong checksum: the device keeps silent.
      if (std::strtol(text.substr(colon + 1).c_str(), nullptr, 16) != lrc(text.substr(0, colon)))
        return;
      text.erase(colon);
    }
    int address = 0, axis = 0, id = -1;
    take_number(text, address);
    take_number(text, axis);
    take_number(text, id);
    if (address != 0 && address != 1) return;
    answer(axis, id, text);
  }

  void tick() override {
    if (was_moving_ && !moving()) send(fmt::format("!01 1 IDLE {}", flag()));
    was_moving_ = moving();
    if (!homing_) axis_.top_speed = set_speed_;
  }

  void on_stall() override {
    axis_.halt();
    homing_ = false;
    fault_ = std::string("FS");
  }
  void on_overheat() override { fault_ = std::string("WT"); }
  void on_power_cut() override {
    Emulator::on_power_cut();
    fault_.clear();
  }

 private:
  static void take_number(std::string& text, int& value) {
    std::size_t at = text.find_first_not_of(' ');
    if (at == std::string::npos || text[at] < '0' || text[at] > '9') return;
    char* end = nullptr;
    value = static_cast<int>(std::strtol(text.c_str() + at, &end, 10));
    text.erase(0, static_cast<std::size_t>(end - text.c_str()));
  }

  std::string flag() const {
    if (!fault_.empty()) return fault_;
    return homed_ ? "--" : "WR";
  }

  void send(const std::string& message) {
    reply(checksums_ ? fmt::format("{}:{:02X}", message, lrc(message.substr(1))) : message);
  }

  void answer(int axis, int id, const std::string& text) {
    std::string refusal;
    std::string data = std::string("0");
    execute(text, data, refusal);
    const std::string number = id >= 0 ? fmt::format("{:02} ", id) : "";
    send(fmt::format("@01 {} {}{} {} {} {}", axis, number, refusal.empty() ? "OK" : "RJ",
                     moving() ? "BUSY" : "IDLE", flag(), refusal.empty() ? data : refusal));
  }

  void execute(const std::string& text, std::string& data, std::string& refusal) {
    std::istringstream words(text);
    std::string verb, what, value;
    words >> verb >> what >> value;
    if (verb.empty()) return;
    if (verb == "get") return get(what, data, refusal);
    if (verb == "set") return set(what, value, refusal);
    if (verb == "move" && what == "abs") return move(std::atol(value.c_str()), refusal);
    if (verb == "move" && what == "rel")
      return move(std::lround(count()) + std::atol(value.c_str()), refusal);
    if (verb == "home") {
      axis_.top_speed = 30000;
      begin_homing();
    } else if (verb == "warnings") {
      if (what.empty())
        data = fault_.empty() ? (homed_ ? std::string("00") : std::string("01 WR"))
                              : (homed_ ? "01 " + fault_ : "02 " + fault_ + " WR");
      if (what == "clear" && fault_ == "FS") fault_.clear();
    } else if (verb == "stop") {
      homing_ = false;
      axis_.stop();
    } else if (verb == "estop") {
      homing_ = false;
      axis_.halt();
    } else {
      refusal = std::string("BADCOMMAND");
    }
  }

  void get(const std::string& what, std::string& data, std::string& refusal) {
    if (what == "pos") {
      data = fmt::format("{}", std::lround(count()));
    } else if (what == "limit.max") {
      data = fmt::format("{}", kLimitMax + surplus());
    } else if (what == "limit.min") {
      data = fmt::format("{}", -surplus());
    } else if (what == "deviceid") {
      data = std::string("30111");
    } else if (what == "version") {
      data = std::string("6.14");
    } else if (what == "maxspeed") {
      data = fmt::format("{}", std::lround(set_speed_ * kSpeedUnit));
    } else {
      refusal = std::string("BADCOMMAND");
    }
  }

  void set(const std::string& what, const std::string& value, std::string& refusal) {
    const long number = std::atol(value.c_str());
    if (what == "comm.checksum") {
      checksums_ = number != 0;
    } else if (what == "maxspeed") {
      if (number < 1)
        refusal = std::string("BADDATA");
      else
        set_speed_ = double(number) / kSpeedUnit;
    } else {
      refusal = std::string("BADCOMMAND");
    }
  }

  void move(long target, std::string& refusal) {
    begin_move();
    if (target < -surplus() || target > kLimitMax + surplus()) {
      refusal = std::string("BADDATA");
      return;
    }
    aim_at(double(std::clamp(target, 0L, kLimitMax)));
  }

  long surplus() const { return std::lround(strength(FaultKind::kShortTravel) / kMicrostep_mm); }

  bool checksums_ = false;
  bool was_moving_ = false;
  double set_speed_ = 0;
  std::string fault_;
};

}  // namespace

std::unique_ptr<Emulator> zaber_emulator(unsigned seed, bool homed) {
  return std::make_unique<ZaberEmulator>(seed, homed);
}

}  // namespace hydrodip
