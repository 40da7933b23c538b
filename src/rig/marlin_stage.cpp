// A printer's Z axis under Marlin. Source: https://marlinfw.org/docs/gcode/ (G1, G28, M92, M110,
// M112, M114, M115, M211, M220, M410, M420) and "Host requirements": one command, one `ok`; lines
// carry a number and the XOR of their bytes, so that a garbled one is asked for again.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "base/parse_double.h"
#include "rig/stage.h"

namespace hydrodip {
namespace {

constexpr int kAttempts = 3;
constexpr int kMostLinesLost = 2;
// Half of the last digit that a printer shows of where it goes, and a little.
constexpr double kShown_mm = 0.006;
// Between two looks that tell whether it stands still.
constexpr double kLooksApart_s = 0.04;
// Boards restart when their port is opened.
constexpr double kStartTimeout_s = 10;
// While it homes, Marlin says "busy" every two seconds.
constexpr double kBusyTimeout_s = 5;
// Some move away from the end that they have found: by no more than this share of their travel.
constexpr double kHomeShare = 0.1;
// No axis has others.
constexpr double kLeastStepsPerMm = 0.01, kMostStepsPerMm = 1e6, kFurthest_mm = 1e5;

std::string numbered(int number, const std::string& text) {
  const std::string body = fmt::format("N{} {}", number, text);
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("{}*{}\n", body, sum);
}

// The finite number after `label` in `line`, from `begin` on.
std::optional<double> number_after(const std::string& line, const std::string& label,
                                   std::size_t begin = 0) {
  const std::size_t at = line.find(label, begin);
  if (at == std::string::npos) return {};
  const char* first = line.data() + at + label.size();
  while (first < line.data() + line.size() && *first == ' ') ++first;
  double value = 0;
  const auto [end, error] = parse_double(first, line.data() + line.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {};
  return value;
}

constexpr int kUnreadable = -1;

// Of a line that asks for another one again, that one's number, or kUnreadable.
std::optional<int> asked_again(const std::string& line) {
  constexpr double kMostLines = 1e9;
  constexpr const char* kLabel = "Resend:";
  if (line.find(kLabel) == std::string::npos) return {};
  const double wanted = number_after(line, kLabel).value_or(kUnreadable);
  const bool is_number = wanted >= 0 && wanted <= kMostLines && wanted == std::floor(wanted);
  return is_number ? int(wanted) : kUnreadable;
}

class MarlinStage : public Stage {
 public:
  MarlinStage(Link& link, Clock& clock, const StageOptions& options)
      : link_(link), clock_(clock), lines_(link, clock), down_(options.down) {}

  StageIdentity connect() override {
    wait_for_start();
    StageIdentity identity;
    identity.name = firmware_name(exchange("M115"));
    // Before anything is asked that comes in the unit that somebody has left it in.
    exchange("G21");
    exchange("G90");
    steps_per_mm_ = find_number("M92", "M92", " Z");
    if (!(steps_per_mm_ >= kLeastStepsPerMm && steps_per_mm_ <= kMostStepsPerMm))
      throw StageError(fmt::format(
          "the printer says that its Z axis makes {:g} steps per mm: set it right there (M92)",
          steps_per_mm_));
    identity.step_mm = 1 / steps_per_mm_;
    identity.unsure_mm = kShown_mm;
    identity.min_mm = find_number("M211", "Min:", " Z");
    identity.max_mm = find_number("M211", "Max:", " Z");
    min_mm_ = identity.min_mm;
    max_mm_ = identity.max_mm;
    if (!(min_mm_ < max_mm_ && min_mm_ >= -kFurthest_mm && max_mm_ <= kFurthest_mm))
      throw StageError(fmt::format(
          "the printer says that its Z axis goes from {:g} to {:g} mm: set its travel there (M211)",
          min_mm_, max_mm_));
    // So that the first look tells whether it moves.
    position_mm_ = read_position().value_or(0);
    clock_.sleep(kLooksApart_s);
    connected_ = true;
    return identity;
  }

  StageState state() override {
    if (halted_) return halted_state();
    if (homing_) return homing_state();
    const auto position = read_position();
    require_right_way();
    StageState state;
    state.homed = state.position_known = homed_;
    const bool changed = position && std::abs(*position - position_mm_) > 0.5 / steps_per_mm_;
    if (position) position_mm_ = *position;
    const bool under_way =
        aimed_ && std::abs(*aimed_ - position_mm_) > 0.5 / steps_per_mm_ + offset_error_mm();
    const bool there = aimed_ && !changed && !under_way && offset_mm_ != 0;
    state.position_mm = there ? *aimed_ : position_mm_;
    state.moving = changed || under_way || !position || (stopping_ && !has_come_to_rest());
    return state;
  }

  void start_homing() override {
    homed_ = false;
    homing_refused_.clear();
    homing_asked_ = 0;
    offset_mm_ = 0;
    send_homing(next_line_++);
    aimed_.reset();
    stopping_.reset();
    heard_s_ = clock_.now_s();
  }

  // The printer's knob changes what share of it is driven, at any time.
  void set_speed(double mm_per_min) override {
    speed_mm_per_min_ = mm_per_min;
    exchange("M220 S100");
  }

  void aim(double position_mm) override {
    if (halted_) throw StageError(halted_state().fault);
    if (!aimed_ || *aimed_ != position_mm)
      exchange(fmt::format("G1 Z{:.4f} F{:.2f}", position_mm, speed_mm_per_min_));
    aimed_ = position_mm;
    stopping_.reset();
  }

  void acknowledge() override {}

  // Homing listens to nothing but the emergency stop.
  void stop() override {
    if (homing_) return halt();
    if (halted_) return;
    stopping_ = Stopping();
    aimed_.reset();
    for (const std::string& line : exchange("M410"))
      if (line.find("Unknown command") != std::string::npos)
        throw StageError("the printer did not understand that it is to stop");
  }

  void halt() override {
    if (halted_) return;
    link_.send("M112\n");
    const double deadline_s = clock_.now_s() + kReplyTimeout_s;
    while (const auto line = lines_.line(deadline_s))
      if (is_halt(*line)) return set_halted();
    throw LinkError("the printer did not confirm its emergency stop");
  }

 private:
  // The lines before the `ok`. A repeated line is executed once: Marlin counts them.
  std::vector<std::string> exchange(const std::string& text) {
    int number = next_line_++;
    std::string unreadable;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      link_.send(numbered(number, text));
      const double deadline_s = clock_.now_s() + kReplyTimeout_s / kAttempts;
      std::vector<std::string> answer;
      bool repeat = false, executed = false;
      while (const auto line = lines_.line(deadline_s)) {
        if (line->starts_with("ok")) {
          if (!repeat) return answer;
          break;
        }
        if (const auto wanted = asked_again(*line)) {
          executed = *wanted == number + 1;
          repeat = !executed;
          if (*wanted == kUnreadable)
            unreadable = *line;
          else if (repeat)
            renumber(number, *wanted);
          continue;
        }
        refuse_errors(*line);
        answer.push_back(*line);
      }
      if (executed) return answer;
    }
    if (!unreadable.empty())
      throw LinkError(fmt::format(
          "the printer asks for a line again and does not say which ('{}'): check cable, power and "
          "stage.baud",
          unreadable));
    throw LinkError(fmt::format(
        "the printer did not answer '{}' within {:g} s: check cable, power and stage.baud", text,
        kReplyTimeout_s));
  }

  // An earlier line was lost for good: the printer still waits for its number.
  void renumber(int& number, int wanted) {
    if (number - wanted > kMostLinesLost || number < wanted) set_restarted(wanted);
    if (!homing_ && wanted <= homing_number_) {
      homed_ = false;
      next_line_ = wanted;
      throw StageError("the printer has not got the command to home: home it again");
    }
    number = wanted;
    next_line_ = wanted + 1;
  }

  static bool is_halt(const std::string& line) {
    return line.find("halted") != std::string::npos || line.find("kill()") != std::string::npos;
  }

  void set_halted() {
    halted_ = true;
    homed_ = homing_ = false;
  }

  // It counts lines from `next` on.
  [[noreturn]] void set_restarted(int next) {
    homed_ = homing_ = false;
    aimed_.reset();
    next_line_ = next;
    homing_number_ = -1;
    throw StageError("the printer has started anew and forgotten its home: was its power cut?");
  }

  void refuse_errors(const std::string& line) {
    if (line == "start" && connected_) set_restarted(0);
    if (is_halt(line)) {
      set_halted();
      throw StageError("the printer has halted itself (" + line + "): reset it");
    }
    const bool asks_again =
        line.find("hecksum") != std::string::npos || line.find("Line Number") != std::string::npos;
    if (line.starts_with("Error:") && !asks_again) throw StageError("the printer reports: " + line);
  }

  void wait_for_start() {
    const double deadline_s = clock_.now_s() + kStartTimeout_s;
    for (;;) {
      lines_.clear();
      next_line_ = 0;
      try {
        exchange("M110 N0");
        return;
      } catch (const LinkError&) {
        if (clock_.now_s() >= deadline_s) throw;
        clock_.sleep(1);
      }
    }
  }

  static std::string firmware_name(const std::vector<std::string>& answer) {
    const std::string label = "FIRMWARE_NAME:";
    for (const std::string& line : answer) {
      const std::size_t at = line.find(label);
      if (at == std::string::npos) continue;
      const std::string name = line.substr(at + label.size());
      return name.substr(0, name.find(" SOURCE_CODE"));
    }
    return "printer of unknown make";
  }

  // Of the answer's line with `mark`, the number that follows `label` after it.
  double find_number(const std::string& command, const std::string& mark,
                     const std::string& label) {
    for (int attempt = 0; attempt < 3; ++attempt)
      for (const std::string& line : exchange(command)) {
        const std::size_t at = line.find(mark);
        if (at == std::string::npos) continue;
        if (const auto value = number_after(line, label, at)) return *value;
      }
    throw StageError(fmt::format(
        "the printer's answer to {} does not say its Z axis' values: is its firmware Marlin 2?",
        command));
  }

  // The steppers' own count: the other figures of M114 tell where the last command leads. They
  // count from elsewhere if somebody has set an offset for the home (M206).
  std::optional<double> read_position() {
    const auto steps = read_steps();
    if (!steps) return {};
    return *steps / steps_per_mm_ + offset_mm_;
  }
  std::optional<double> read_steps() {
    leads_to_.reset();
    for (const std::string& line : exchange("M114")) {
      const std::size_t count = line.find("Count");
      if (count == std::string::npos) continue;
      if (line.find("Z:") < count) leads_to_ = number_after(line, "Z:");
      if (const auto steps = number_after(line, "Z:", count)) return steps;
    }
    return {};
  }

  // An offset is known by figures of two digits.
  double offset_error_mm() const { return offset_mm_ != 0 ? kShown_mm : 0; }

  // After a stop nobody knows where it was going. Two looks within a moment see the same place even
  // if it moves.
  bool has_come_to_rest() {
    const bool leads_away =
        leads_to_ && std::abs(*leads_to_ - position_mm_) > kShown_mm + offset_error_mm();
    const bool same = std::abs(position_mm_ - stopping_->seen_mm) <= 0.5 / steps_per_mm_;
    if (leads_away || !same) {
      stopping_ = {position_mm_, clock_.now_s()};
      return false;
    }
    if (clock_.now_s() - stopping_->seen_s < kLooksApart_s) return false;
    stopping_.reset();
    return true;
  }

  // Lines carry a weak sum: two wrong bits may look right. And firmware cuts off what lies beyond
  // its own limits without a word. Answers carry none at all, so they are asked for twice.
  void require_right_way() {
    for (int asked = 1; is_wrong_way(); ++asked) {
      if (asked == kAttempts)
        throw StageError(fmt::format(
            "the printer goes to {:.2f} mm, not to {:.2f} mm as it was told: its travel ends "
            "earlier than it says, or the link garbles what it carries",
            *leads_to_, *aimed_));
      read_position();
    }
  }
  bool is_wrong_way() const {
    return homed_ && aimed_ && leads_to_ && std::abs(*leads_to_ - *aimed_) > kShown_mm;
  }

  void send_homing(int number) {
    link_.send(numbered(number, "G28 Z"));
    homing_ = true;
    homing_number_ = number;
    homing_again_ = false;
    ++homing_asked_;
  }

  StageState homing_state() {
    while (const auto line = lines_.line(clock_.now_s() + 0.05)) {
      refuse_errors(*line);
      heard_s_ = clock_.now_s();
      if (const auto wanted = asked_again(*line)) {
        homing_again_ = *wanted <= homing_number_;
        if (homing_again_ && *wanted != kUnreadable) renumber(homing_number_, *wanted);
      }
      // Whatever it refuses or does not understand ends with ok all the same.
      const std::size_t home = line->find("Home ");
      if (home != std::string::npos && line->find(" First", home) != std::string::npos)
        homing_refused_ = *line;
      if (line->find("Unknown command") != std::string::npos) homing_again_ = true;
      if (!line->starts_with("ok")) continue;
      if (homing_again_ && homing_asked_ < kAttempts) {
        send_homing(homing_number_);
        continue;
      }
      homing_ = false;
      require_home();
      homed_ = true;
      return state();
    }
    if (clock_.now_s() - heard_s_ > kBusyTimeout_s)
      throw LinkError("the printer fell silent while homing");
    StageState state;
    state.position_mm = position_mm_;
    state.position_known = false;
    state.moving = true;
    return state;
  }

  // That it says ok does not mean that it is there.
  void require_home() {
    if (homing_again_) throw StageError("the printer has not got the command to home");
    if (!homing_refused_.empty())
      throw StageError(fmt::format(
          "the printer has not homed Z ('{}'): only one that homes Z by itself and at the top can "
          "carry an object, and Z_SAFE_HOMING is for those that home towards their bed",
          homing_refused_));
    // Levelling shifts Z by something else at every height.
    exchange("M420 S0");
    find_offset();
    position_mm_ = read_position().value_or(position_mm_);
    const double top_mm = down_ == StageDown::kPlus ? min_mm_ : max_mm_;
    if (std::abs(position_mm_ - top_mm) <= kHomeShare * (max_mm_ - min_mm_)) return;
    throw StageError(fmt::format(
        "the printer's home is at {:.2f} mm, and the top of its travel at {:.2f} mm "
        "(stage.down={}): it has homed towards its bed or not at all, or stage.down is wrong; it "
        "must home Z away from the bath",
        position_mm_, top_mm, down_ == StageDown::kPlus ? "plus" : "minus"));
  }

  // Where it stands still, figures and count are of one place. Answers may be garbled: two have to
  // agree.
  void find_offset() {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto steps = read_steps();
      const auto shown_mm = leads_to_;
      if (!steps || read_steps() != steps || leads_to_ != shown_mm) continue;
      if (!shown_mm) return;
      const double offset_mm = *shown_mm - *steps / steps_per_mm_;
      if (std::abs(offset_mm) > kShown_mm) offset_mm_ = std::round(100 * offset_mm) / 100;
      return;
    }
    throw StageError("the printer's answers to M114 do not agree, though it stands at its home");
  }

  StageState halted_state() const {
    StageState state;
    state.position_mm = position_mm_;
    state.position_known = false;
    state.fault = "the printer is halted: reset it";
    return state;
  }

  Link& link_;
  Clock& clock_;
  LineReader lines_;
  int next_line_ = 0;
  double steps_per_mm_ = 1;
  double speed_mm_per_min_ = 60;
  StageDown down_;
  double min_mm_ = 0, max_mm_ = 0;
  double offset_mm_ = 0;  // what the printer shows over what its steps come to
  double position_mm_ = 0;
  std::optional<double> aimed_;     // where it was sent; unknown after a stop
  std::optional<double> leads_to_;  // where it says that it goes
  bool connected_ = false, homing_ = false, homed_ = false, halted_ = false;
  int homing_number_ = -1, homing_asked_ = 0;  // the line that was to home it, and how often
  bool homing_again_ = false;                  // it was asked for once more
  std::string homing_refused_;                 // why it has not homed, in its words
  double heard_s_ = 0;
  // After a stop: where it was seen, and since when there.
  struct Stopping {
    double seen_mm = std::numeric_limits<double>::infinity();
    double seen_s = 0;
  };
  std::optional<Stopping> stopping_;
};

}  // namespace

std::unique_ptr<Stage> marlin_stage(Link& link, Clock& clock, const StageOptions& options) {
  return std::make_unique<MarlinStage>(link, clock, options);
}

}  // namespace hydrodip
