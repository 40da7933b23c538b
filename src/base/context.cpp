#include "base/context.h"

#include <algorithm>

#include "base/error.h"

namespace hydrodip {

void RunContext::progress(const std::string& stage, double fraction) {
  check_cancelled();
  const std::lock_guard lock(progress_mutex_);
  if (progress_sink_) progress_sink_(stage, std::clamp(fraction, 0.0, 1.0));
}

void RunContext::check_cancelled() const {
  if (cancelled()) throw Cancelled();
}

void RunContext::log(const std::string& line) {
  if (log_sink_) log_sink_(line);
}

void RunContext::warn(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  if (std::find(warnings_.begin(), warnings_.end(), sentence) == warnings_.end())
    warnings_.push_back(sentence);
}

std::vector<std::string> RunContext::warnings() const {
  const std::lock_guard lock(mutex_);
  return warnings_;
}

}  // namespace hydrodip
