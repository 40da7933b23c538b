// The run context that every long step takes: progress, cancellation, warnings, log and a share of
// the processor's threads. It holds no global state, so several jobs can run in one process.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hydrodip {

class ThreadBudget;

// A handle: cheap to copy, and copies stand for the same job. Everything may be called from any
// thread, also through a const reference.
class RunContext {
 public:
  // activity: what is being done, in words ("dipping"); fraction in [0, 1] of that activity.
  using ProgressSink = std::function<void(const std::string& activity, double fraction)>;
  // One line for people who follow along; never needed to understand the result. For users of the
  // library: the program itself shows none.
  using LogSink = std::function<void(const std::string& line)>;

  // A job of its own, with all of the processor's threads.
  RunContext();

  // ---- what is told ----

  // A sink is called by one thread at a time, and calls neither of these two.
  void on_progress(ProgressSink sink) const;
  void on_log(LogSink sink) const;

  // Reports progress and throws Cancelled if the job was cancelled.
  void progress(const std::string& activity, double fraction) const;

  void log(const std::string& line) const;

  // A sentence for the user about something tolerated; collected for the report. Repeating a
  // sentence is ignored.
  void warn(const std::string& sentence) const;
  std::vector<std::string> warnings() const;

  // ---- cancellation ----

  // Async-signal-safe: may be called from a signal handler.
  void cancel() const;
  bool cancelled() const { return cancel_requests() > 0; }
  // More than one: the user is in a hurry. A job that drives a machine stops it at once then.
  int cancel_requests() const;

  // Throws Cancelled if the job was cancelled. Cheap. Loops and files do this by themselves: see
  // run_scope.h.
  void check_cancelled() const;

  // A job that has to act on the second request as well says so; else the program ends there.
  void expect_second_cancel() const;
  bool expects_second_cancel() const;

  // For tests, which find out so that a job can be stopped wherever it looks: the n-th check from
  // now on (n > 0) finds it cancelled. How many there are can depend on the number of threads.
  void cancel_at_check(std::int64_t n) const;
  // Since cancel_at_check().
  std::int64_t checks() const;

  // ---- parts of a job ----

  // The same job, of whose threads at most so many are used. 0: no fewer.
  RunContext with_threads(int threads) const;
  // How many its loops may use.
  int threads() const;

  // For a part of the job that nobody has to hear of. It is cancelled when the job is, and can be
  // cancelled alone; progress and log end there, and it keeps its warnings to itself.
  RunContext quiet() const;

  // Runs the tasks side by side as one activity, whose progress is how many are done: that of the
  // tasks' own activities is not shown. Exceptions as by parallel_do().
  void side_by_side(const std::string& activity,
                    const std::vector<std::function<void()>>& tasks) const;

 private:
  struct Cancellation;
  struct Voice;

  void show_progress(const std::string& activity, double fraction) const;

  std::shared_ptr<Cancellation> cancellation_;
  std::shared_ptr<Voice> voice_;
  std::shared_ptr<ThreadBudget> budget_;  // none: all threads

  friend class RunScope;
};

}  // namespace hydrodip
