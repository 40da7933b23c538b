// A printer under Marlin, as far as its Z axis goes.
#include <fmt/format.h>

#include <cstdlib>
#include <deque>

#include "emulator.h"

namespace hydrodip {
namespace {

constexpr double kStepsPerMm = 400;
constexpr double kZMax_mm = 200;

class MarlinEmulator : public Emulator {
 public:
  MarlinEmulator(unsigned seed, const MarlinHabits& habits) : Emulator(seed), habits_(habits) {
    step_mm_ = 1 / kStepsPerMm;
    axis_.position = axis_.target = 30 * kStepsPerMm;
    count_from_here();
    axis_.acceleration = 100 * kStepsPerMm;
    axis_.top_speed = 10 * kStepsPerMm;
  }

 protected:
  void handle(const std::string& line) override {
    if (killed_) return;
    // The emergency parser sees these at once, in any state.
    if (line.find("M112") != std::string::npos) return kill("kill() called");
    if (homing_ || !waiting_.empty()) {
      waiting_.push_back(line);
      return;
    }
    take(line);
  }

  void tick() override {
    if (was_homing_ && !homing_) {
      reply(place());
      reply("ok");
      std::deque<std::string> lines;
      lines.swap(waiting_);
      for (const std::string& line : lines) handle(line);
    }
    was_homing_ = homing_;
    if (homing_ && now_s_ - busy_s_ > 2) {
      busy_s_ = now_s_;
      reply("echo:busy: processing");
    }
  }

  void on_stall() override { kill("Z driver fault"); }
  void on_overheat() override { kill("MAXTEMP triggered"); }
  void on_power_cut() override {
    Emulator::on_power_cut();
    killed_ = was_homing_ = false;
    habits_.inches = false;
    habits_.feed_percent = 100;
    last_number_ = -1;
    waiting_.clear();
    if (strength(FaultKind::kBlink) == 0) reply("start");
  }

 private:
  void kill(const std::string& why) {
    axis_.halt();
    homing_ = was_homing_ = homed_ = false;
    killed_ = true;
    waiting_.clear();
    reply("Error:" + why);
    reply("Error:Printer halted. kill() called!");
  }

  void ask_again(const std::string& why) {
    reply(fmt::format("Error:{}, Last Line: {}", why, last_number_));
    reply(fmt::format("Resend: {}", last_number_ + 1));
    reply("ok");
  }

  void take(const std::string& line) {
    std::string text = line;
    if (text[0] == 'N') {
      const std::size_t star = text.rfind('*');
      if (star == std::string::npos) return ask_again("No Checksum with line number");
      int sum = 0;
      for (std::size_t i = 0; i < star; ++i) sum ^= static_cast<unsigned char>(text[i]);
      if (std::atoi(text.c_str() + star + 1) != sum) return ask_again("checksum mismatch");
      const int number = std::atoi(text.c_str() + 1);
      const std::size_t space = text.find(' ');
      if (space == std::string::npos) return ask_again("checksum mismatch");
      text = text.substr(space + 1, star - space - 1);
      if (text.rfind("M110", 0) == 0) last_number_ = number - 1;
      if (number != last_number_ + 1) return ask_again("Line Number is not Last Line Number+1");
      last_number_ = number;
    }
    execute(text);
  }

  static double value(const std::string& text, char letter, double otherwise) {
    const std::size_t at = text.find(letter, 1);
    return at == std::string::npos ? otherwise : std::atof(text.c_str() + at + 1);
  }

  double unit_mm() const { return habits_.inches ? 25.4 : 1; }
  // Where its steps put it; before it has homed it counts from where it was switched on.
  double native_mm(double count) const { return count * step_mm_ + (homed_ ? habits_.home_mm : 0); }
  double shown(double native_mm) const { return (native_mm + habits_.home_offset_mm) / unit_mm(); }
  std::string place() const {
    return fmt::format("X:0.00 Y:0.00 Z:{:.2f} E:0.00 Count X:0 Y:0 Z:{}",
                       shown(native_mm(axis_.target - axis_.position + count())),
                       std::lround(native_mm(count()) * kStepsPerMm));
  }

  void execute(const std::string& text) {
    if (text.rfind("G28", 0) == 0) {
      if (habits_.wants_xy_first) {
        reply("echo:Home XY First");
        return reply("ok");
      }
      axis_.top_speed = 20 * kStepsPerMm;
      busy_s_ = now_s_;
      was_homing_ = true;
      begin_homing();
      return;  // ok when it is done
    }
    if (text.rfind("G1 ", 0) == 0) {
      begin_move();
      axis_.top_speed =
          value(text, 'F', 600) * unit_mm() * habits_.feed_percent / 100 / 60 * kStepsPerMm;
      const double z_mm = value(text, 'Z', shown(native_mm(count()))) * unit_mm();
      aim_at(kStepsPerMm *
             (std::clamp(z_mm - habits_.home_offset_mm, 0.0, kZMax_mm) - native_mm(0)));
    } else if (text == "M410") {
      axis_.stop();
    } else if (text == "M114") {
      reply(place());
    } else if (text == "M115") {
      reply(
          "FIRMWARE_NAME:Marlin 2.1.2 SOURCE_CODE_URL:github.com/MarlinFirmware/Marlin "
          "PROTOCOL_VERSION:1.0 MACHINE_TYPE:3D Printer EXTRUDER_COUNT:1");
    } else if (text == "M92") {
      reply(fmt::format("  M92 X80.00 Y80.00 Z{:.2f} E93.00", kStepsPerMm * unit_mm()));
    } else if (text == "M211") {
      const double surplus_mm = strength(FaultKind::kShortTravel);
      reply(fmt::format(
          "Soft endstops: On  Min:  X0.00 Y0.00 Z{:.2f}   Max:  X200.00 Y200.00 Z{:.2f}",
          shown(-surplus_mm), shown(kZMax_mm + surplus_mm)));
    } else if (text == "G21") {
      habits_.inches = false;
    } else if (text.rfind("M220 S", 0) == 0) {
      habits_.feed_percent = value(text, 'S', 100);
    } else if (text != "G90" && text.rfind("M110", 0) != 0) {
      reply("echo:Unknown command: \"" + text + "\"");
    }
    reply("ok");
  }

  MarlinHabits habits_;
  bool killed_ = false, was_homing_ = false;
  int last_number_ = -1;
  double busy_s_ = 0;
  std::deque<std::string> waiting_;
};

}  // namespace

std::unique_ptr<Emulator> marlin_emulator(unsigned seed, const MarlinHabits& habits) {
  return std::make_unique<MarlinEmulator>(seed, habits);
}

}  // namespace hydrodip
