#include "base/context.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"

namespace hydrodip {

void RunContext::progress(const std::string& stage, double fraction) {
  check_cancelled();
  if (!side_by_side_) show_progress(stage, fraction);
}

void RunContext::show_progress(const std::string& stage, double fraction) {
  const std::lock_guard lock(progress_mutex_);
  if (progress_sink_) progress_sink_(stage, std::clamp(fraction, 0.0, 1.0));
}

void RunContext::side_by_side(const std::string& stage,
                              const std::vector<std::function<void()>>& tasks) {
  progress(stage, 0);
  std::mutex counting;
  int done = 0;
  std::vector<std::function<void()>> counted;
  counted.reserve(tasks.size());
  for (const auto& task : tasks)
    counted.emplace_back([&, task] {
      task();
      const std::lock_guard lock(counting);  // counted and shown in the same order
      show_progress(stage, ++done / double(tasks.size()));
    });
  side_by_side_ = true;
  try {
    parallel_do(counted);
  } catch (...) {
    side_by_side_ = false;
    throw;
  }
  side_by_side_ = false;
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
