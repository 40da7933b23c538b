#include "rig/link.h"

namespace hydrodip {

// Noise without line ends must not fill the memory.
constexpr std::size_t kLongestLine = 1024;

void Clock::sleep(double seconds) {
  const double until = now_s() + seconds;
  for (double left = seconds; left > 0; left = until - now_s()) wait_readable(-1, left);
}

std::optional<std::string> LineReader::line(double deadline_s) {
  for (;;) {
    const std::size_t end = pending_.find_first_of("\r\n");
    if (end != std::string::npos) {
      const std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      if (!line.empty()) return line;
      continue;
    }
    if (pending_.size() > kLongestLine) pending_.clear();
    const double left = deadline_s - clock_.now_s();
    if (left <= 0) return {};
    pending_ += link_.receive(left);
  }
}

void LineReader::clear() {
  pending_.clear();
  while (!link_.receive(0).empty()) continue;
}

}  // namespace hydrodip
