#include "base/context.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "base/thread_budget.h"
#include "base/thread_supply.h"

namespace hydrodip {

// Everything that a signal handler touches is a lock-free atomic, and the parents never change.
struct RunContext::Cancellation {
  std::shared_ptr<Cancellation> parent;  // cancels this one too; none: a job of its own
  std::atomic<int> requests{0};
  std::atomic<bool> expects_second{false};
  // For tests.
  std::atomic<bool> counts_checks{false};
  std::atomic<std::int64_t> checks{0}, last_check{0};

  void check() {
    if (!counts_checks.load(std::memory_order_relaxed)) return;
    if (checks.fetch_add(1, std::memory_order_relaxed) + 1 >= last_check) requests = 1;
  }
};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

struct RunContext::Voice {
  std::mutex progress_mutex, log_mutex, warnings_mutex;
  std::atomic<int> activities_side_by_side{0};
  ProgressSink progress_sink;
  LogSink log_sink;
  std::vector<std::string> warnings;
};

RunContext::RunContext()
    : cancellation_(std::make_shared<Cancellation>()), voice_(std::make_shared<Voice>()) {}

void RunContext::on_progress(ProgressSink sink) const {
  const std::lock_guard lock(voice_->progress_mutex);
  voice_->progress_sink = std::move(sink);
}

void RunContext::on_log(LogSink sink) const {
  const std::lock_guard lock(voice_->log_mutex);
  voice_->log_sink = std::move(sink);
}

void RunContext::progress(const std::string& activity, double fraction) const {
  check_cancelled();
  if (voice_->activities_side_by_side == 0) show_progress(activity, fraction);
}

void RunContext::show_progress(const std::string& activity, double fraction) const {
  const std::lock_guard lock(voice_->progress_mutex);
  if (voice_->progress_sink) voice_->progress_sink(activity, std::clamp(fraction, 0.0, 1.0));
}

void RunContext::log(const std::string& line) const {
  const std::lock_guard lock(voice_->log_mutex);
  if (voice_->log_sink) voice_->log_sink(line);
}

void RunContext::warn(const std::string& sentence) const {
  const std::lock_guard lock(voice_->warnings_mutex);
  std::vector<std::string>& all = voice_->warnings;
  if (std::find(all.begin(), all.end(), sentence) == all.end()) all.push_back(sentence);
}

std::vector<std::string> RunContext::warnings() const {
  const std::lock_guard lock(voice_->warnings_mutex);
  return voice_->warnings;
}

void RunContext::cancel() const { cancellation_->requests.fetch_add(1, std::memory_order_relaxed); }

int RunContext::cancel_requests() const {
  int most = 0;
  for (const Cancellation* c = cancellation_.get(); c != nullptr; c = c->parent.get())
    most = std::max(most, c->requests.load(std::memory_order_relaxed));
  return most;
}

void RunContext::check_cancelled() const {
  for (Cancellation* c = cancellation_.get(); c != nullptr; c = c->parent.get()) {
    c->check();
    if (c->requests.load(std::memory_order_relaxed) > 0) throw Cancelled();
  }
}

void RunContext::expect_second_cancel() const { cancellation_->expects_second = true; }
bool RunContext::expects_second_cancel() const { return cancellation_->expects_second; }

void RunContext::cancel_at_check(std::int64_t n) const {
  cancellation_->checks = 0;
  cancellation_->last_check = n;
  cancellation_->counts_checks = true;
}

std::int64_t RunContext::checks() const { return cancellation_->checks; }

RunContext RunContext::with_threads(int threads) const {
  RunContext limited = *this;
  if (threads > 0 && threads < this->threads())
    limited.budget_ = std::make_shared<ThreadBudget>(threads);
  return limited;
}

int RunContext::threads() const { return budget_ ? budget_->threads() : threads_in_supply(); }

RunContext RunContext::quiet() const {
  RunContext part;
  part.cancellation_->parent = cancellation_;
  part.budget_ = budget_;
  return part;
}

void RunContext::side_by_side(const std::string& activity,
                              const std::vector<std::function<void()>>& tasks) const {
  const RunScope scope(*this);
  progress(activity, 0);
  std::mutex counting;
  int done = 0;
  std::vector<std::function<void()>> counted;
  counted.reserve(tasks.size());
  const bool shown = voice_->activities_side_by_side++ == 0;
  for (const auto& task : tasks)
    counted.emplace_back([&, task] {
      task();
      const std::lock_guard lock(counting);  // counted and shown in the same order
      ++done;
      if (shown) show_progress(activity, done / double(tasks.size()));
    });
  try {
    parallel_do(counted);
  } catch (...) {
    --voice_->activities_side_by_side;
    throw;
  }
  --voice_->activities_side_by_side;
}

}  // namespace hydrodip
