// The run context that every long stage takes: progress, cancellation, warnings and log. It holds
// no global state, so two jobs can run in one process.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace hydrodip {

class RunContext {
 public:
  // stage: what is being done, in words ("dipping"); fraction in [0, 1] of that stage.
  using ProgressSink = std::function<void(const std::string& stage, double fraction)>;
  // One line for people who follow along; never needed to understand the result.
  using LogSink = std::function<void(const std::string& line)>;

  RunContext() = default;
  RunContext(const RunContext&) = delete;
  RunContext& operator=(const RunContext&) = delete;

  void on_progress(ProgressSink sink) { progress_sink_ = std::move(sink); }
  void on_log(LogSink sink) { log_sink_ = std::move(sink); }

  // Reports progress and throws Cancelled if the job was cancelled. Callable from any thread; the
  // sink is called by one at a time.
  void progress(const std::string& stage, double fraction);

  // Runs the tasks side by side as one stage, whose progress is how many are done: that of the
  // tasks' own stages is not shown. Exceptions as by parallel_do().
  void side_by_side(const std::string& stage, const std::vector<std::function<void()>>& tasks);

  // Throws Cancelled if the job was cancelled. Cheap, callable from any thread.
  void check_cancelled() const;

  // Async-signal-safe: may be called from a signal handler.
  void cancel() { cancel_requests_.fetch_add(1, std::memory_order_relaxed); }
  bool cancelled() const { return cancel_requests() > 0; }
  // More than one: the user is in a hurry. A job that drives a machine stops it at once then.
  int cancel_requests() const { return cancel_requests_.load(std::memory_order_relaxed); }

  // A job that has to act on the second request as well says so; else the program ends there.
  void expect_second_cancel() { expects_second_.store(true, std::memory_order_relaxed); }
  bool expects_second_cancel() const { return expects_second_.load(std::memory_order_relaxed); }

  void log(const std::string& line);

  // A sentence for the user about something tolerated; collected for the report, thread-safe.
  // Repeating a sentence is ignored.
  void warn(const std::string& sentence);
  std::vector<std::string> warnings() const;

 private:
  void show_progress(const std::string& stage, double fraction);

  static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);
  std::atomic<int> cancel_requests_{0};
  std::atomic<bool> expects_second_{false};
  std::mutex progress_mutex_;
  std::atomic<bool> side_by_side_{false};
  ProgressSink progress_sink_;
  LogSink log_sink_;
  mutable std::mutex mutex_;
  std::vector<std::string> warnings_;
};

}  // namespace hydrodip
