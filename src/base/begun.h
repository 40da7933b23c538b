// Work that goes on while its caller does something else.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/run_scope.h"

namespace hydrodip {

// Begins on a thread of its own, for the job of the calling thread. Where the job may not use one
// more thread, inside a parallel loop, or where the system gives none, the work is done when it is
// waited for. Ends when the work has.
class BegunWork {
 public:
  explicit BegunWork(std::function<void()> work);
  ~BegunWork();
  BegunWork(const BegunWork&) = delete;
  BegunWork& operator=(const BegunWork&) = delete;

  bool has_begun() const { return thread_.joinable(); }  // until wait()
  // Until it is done or has failed. By one thread at a time.
  void wait();
  bool has_failed() const { return failure_ != nullptr; }  // after wait()
  // Waits, warns of what the work warned of, so that warnings come in the caller's order, and
  // throws what it threw.
  void finish();

 private:
  void run();

  const std::function<void()> work_;
  const std::optional<RunContext> own_;  // hears the warnings; none: nobody's work
  std::exception_ptr failure_;
  bool is_done_ = false;
  std::thread thread_;
};

// The same with a result.
template <class T>
class Begun {
 public:
  explicit Begun(std::function<T()> work)
      : work_([this, work = std::move(work)] { result_ = work(); }) {}

  bool has_begun() const { return work_.has_begun(); }
  void wait() { work_.wait(); }
  bool has_failed() const { return work_.has_failed(); }
  T take() {
    work_.finish();
    return std::move(*result_);
  }

 private:
  std::optional<T> result_;
  BegunWork work_;
};

}  // namespace hydrodip
