#include "emulator.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace hydrodip {
namespace {

constexpr double kTick_s = 1e-3;
constexpr double kStart_s = 1;
constexpr double kHeard_s = 0.5;

}  // namespace

Emulator::Emulator(unsigned seed) : random_(seed) {
  std::array<char, 128> name;
  termios raw{};
  ::cfmakeraw(&raw);
  raw.c_cflag |= CS8 | CREAD;
  if (::openpty(&master_, &slave_, name.data(), &raw, nullptr) != 0)
    throw std::runtime_error("no pseudo-terminal");
  ::fcntl(master_, F_SETFL, O_NONBLOCK);
  port_ = name.data();
}

Emulator::~Emulator() { unplug(); }

void Emulator::stand_at(double mm) {
  axis_.position = axis_.target = std::round(mm / step_mm_);
  count_from_here();
}

void Emulator::advance(double now_s) {
  read_wire();
  while (now_s_ + kTick_s / 2 < now_s) {
    now_s_ += kTick_s;
    strike();
    move();
    tick();
    watch();
  }
  deliver();
}

void Emulator::move() {
  if (strength(FaultKind::kStick) > 0)
    axis_.velocity = 0;
  else
    step_axis(1 - strength(FaultKind::kSlow));
  if (!homing_ || axis_.moving()) return;
  homing_ = false;
  homed_ = true;
  count_from_here();
}

void Emulator::step_axis(double pace) {
  const double top_speed = axis_.top_speed;
  axis_.top_speed *= pace;
  axis_.step(kTick_s);
  axis_.top_speed = top_speed;
}

void Emulator::read_wire() {
  std::array<char, 512> buffer;
  while (master_ >= 0) {
    const ssize_t got = ::read(master_, buffer.data(), buffer.size());
    if (got <= 0) return;
    bytes_read_ += static_cast<std::size_t>(got);
    if (mute()) continue;
    for (ssize_t i = 0; i < got; ++i) {
      const char c = buffer[static_cast<std::size_t>(i)];
      if (!ends_line(c)) {
        line_ += c;
        continue;
      }
      if (line_.empty()) continue;
      if (chance(strength(FaultKind::kGarbleCommands))) garble(line_);
      const std::string line = line_;
      line_.clear();
      handle(line);
    }
  }
}

void Emulator::reply(const std::string& line) {
  std::string bytes = line;
  if (chance(strength(FaultKind::kGarbleReplies))) garble(bytes);
  outgoing_.push_back({now_s_ + 0.002 + strength(FaultKind::kSlowReplies), bytes + "\r\n"});
}

bool Emulator::ever(FaultKind kind) const {
  return std::any_of(faults_.begin(), faults_.end(),
                     [&](const Fault& fault) { return fault.kind == kind; });
}

double Emulator::worst(FaultKind kind) const {
  double worst = 0;
  for (const Fault& fault : faults_)
    if (fault.kind == kind) worst = std::max(worst, fault.value);
  return worst;
}

double Emulator::strength(FaultKind kind) const {
  double strongest = 0;
  for (const Fault& fault : faults_)
    if (fault.kind == kind && active(fault)) strongest = std::max(strongest, fault.value);
  return strongest;
}

bool Emulator::chance(double probability) {
  return probability > 0 && std::uniform_real_distribution<double>(0, 1)(random_) < probability;
}

void Emulator::garble(std::string& bytes) {
  std::uniform_int_distribution<std::size_t> place(0, bytes.size() - 1);
  std::uniform_int_distribution<int> bit(0, 6);
  for (int i = 0; i < 2; ++i) {
    char& c = bytes[place(random_)];
    c = static_cast<char>(c ^ (1 << bit(random_)));
  }
}

void Emulator::strike() {
  struck_.resize(faults_.size(), false);
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (struck_[i] || !active(faults_[i])) continue;
    struck_[i] = true;
    if (faults_[i].kind == FaultKind::kStall) on_stall();
    if (faults_[i].kind == FaultKind::kOverheat) on_overheat();
    if (faults_[i].kind == FaultKind::kPowerCut) awake_s_ = now_s_ + kStart_s;
    if (faults_[i].kind == FaultKind::kPowerCut || faults_[i].kind == FaultKind::kBlink)
      on_power_cut();
    if (faults_[i].kind == FaultKind::kSlip && axis_.velocity != 0)
      axis_.position -= std::copysign(1, axis_.velocity) * std::round(faults_[i].value / step_mm_);
    if (faults_[i].kind == FaultKind::kSag && !axis_.moving())
      axis_.position = axis_.target += std::round(faults_[i].value / step_mm_);
    if (faults_[i].kind == FaultKind::kUnplug) unplug();
  }
}

void Emulator::on_power_cut() {
  axis_.halt();
  homed_ = homing_ = false;
  lost_home_s_ = now_s_;
  count_from_here();
}

void Emulator::unplug() {
  for (int* descriptor : {&master_, &slave_}) {
    if (*descriptor >= 0) ::close(*descriptor);
    *descriptor = -1;
  }
}

void Emulator::deliver() {
  while (!outgoing_.empty() && outgoing_.front().due_s <= now_s_) {
    const std::string& bytes = outgoing_.front().bytes;
    if (master_ >= 0 && !mute()) {
      const ssize_t sent = ::write(master_, bytes.data(), bytes.size());
      if (sent > 0) bytes_written_ += static_cast<std::size_t>(sent);
    }
    outgoing_.pop_front();
  }
}

void Emulator::begin_homing() {
  homing_ = true;
  axis_.target = 0;
}

void Emulator::begin_move() {
  if (!homed_ && now_s_ > lost_home_s_ + kHeard_s) moved_unhomed_ = true;
}

void Emulator::stop_due(double at_s) {
  if (!due_s_ || at_s < *due_s_) due_s_ = at_s;
}

void Emulator::watch() {
  if (due_s_ && now_s_ > *due_s_ && moving() && !disobeyed_s_) disobeyed_s_ = now_s_;
  if (moving() && !was_moving_) last_start_s_ = now_s_;
  was_moving_ = moving();
  if (moving()) history_.push_back({now_s_, position_mm()});
}

double Emulator::measured_speed_mm_per_min(double from_mm, double to_mm) const {
  std::optional<double> begin_s;
  double speed = 0;
  for (std::size_t i = 1; i < history_.size(); ++i) {
    const double before = history_[i - 1].mm, after = history_[i].mm;
    if (before < from_mm && after >= from_mm) begin_s = history_[i].time_s;
    if (begin_s && before < to_mm && after >= to_mm)
      speed = 60 * (to_mm - from_mm) / (history_[i].time_s - *begin_s);
  }
  return speed;
}

}  // namespace hydrodip
