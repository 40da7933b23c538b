#include "progress.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "console.h"
#include "harmless.h"

namespace hydrodip {
namespace {

constexpr std::chrono::milliseconds kRedrawEvery{100};
constexpr std::chrono::seconds kPlainLineEvery{1};
// Plain lines are for logs of long jobs; a short one, or one refused at once, needs none.
constexpr std::chrono::seconds kQuietStart{2};
// An estimate needs some evidence first.
constexpr double kEstimateFrom_s = 1;
constexpr double kEstimateFromFraction = 0.02;

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::string show_time(double duration_s) {
  const long whole = std::lround(std::ceil(duration_s));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

ProgressLine::ProgressLine(const std::string& command, bool terminal)
    : terminal_(terminal), job_(command), job_start_(Clock::now()), activity_start_(job_start_) {}

void ProgressLine::update(const std::string& activity, double fraction) {
  const auto now = Clock::now();
  job_.update(activity, fraction);
  const bool new_activity = activity != activity_;
  if (new_activity) {
    activity_ = activity;
    activity_start_ = now;
    tenths_shown_ = -1;
  }
  if (!terminal_) {
    if (now - job_start_ >= kQuietStart) add_line(fraction);
  } else if (new_activity || now - last_draw_ >= kRedrawEvery) {
    last_draw_ = now;
    redraw(fraction);
  }
}

void ProgressLine::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

void ProgressLine::redraw(double fraction) {
  std::fputs(("\r\033[K" + harmless(describe(fraction))).c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressLine::add_line(double fraction) {
  const auto now = Clock::now();
  const int tenths = static_cast<int>(10 * fraction);
  const bool first_of_activity = tenths_shown_ < 0;
  if (!first_of_activity && (tenths == tenths_shown_ || now - last_draw_ < kPlainLineEvery)) return;
  tenths_shown_ = tenths;
  last_draw_ = now;
  print_notice(describe(fraction));
}

std::string ProgressLine::describe(double fraction) const {
  if (!terminal_ && fraction <= 0) return activity_;
  std::string line = fmt::format("{} {:3.0f} %", activity_, std::floor(100 * fraction));
  if (job_.fraction() > 0) line += fmt::format("; job {:.0f} %", std::floor(100 * job_.fraction()));
  const double left = left_s(fraction);
  return left > 0 ? line + ", " + show_time(left) + " left" : line;
}

double ProgressLine::left_s(double fraction) const {
  const auto now = Clock::now();
  if (job_.fraction() > 0) return job_.left_s(seconds(now - job_start_));
  const double spent_s = seconds(now - activity_start_);
  const bool told = spent_s >= kEstimateFrom_s && fraction >= kEstimateFromFraction && fraction < 1;
  return told ? spent_s * (1 - fraction) / fraction : -1;
}

}  // namespace hydrodip
