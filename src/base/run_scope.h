// For whom a thread works. Loops, files and encoders deep inside a step find the job's context
// here, so that a job can be cancelled at any moment without a parameter through every function.
#pragma once

#include <algorithm>
#include <string>

#include "base/context.h"
#include "base/work.h"

namespace hydrodip {

// While it lives, what this thread does belongs to the job: parallel_for uses the job's threads (no
// more than an enclosing scope allows) and throws Cancelled between two chunks once the job is
// cancelled, as does check_cancelled(). Threads that take part in this one's loops belong to the
// job meanwhile. On the stack only.
class RunScope {
 public:
  explicit RunScope(const RunContext& context);
  ~RunScope();
  RunScope(const RunScope&) = delete;
  RunScope& operator=(const RunScope&) = delete;

 private:
  const RunContext context_;
  const Work before_;
};

// Throws Cancelled if the job that this thread works for was cancelled. Cheap enough for every few
// microseconds. For loops without a context at hand.
void check_cancelled();

// RunContext::warn() of that job; where the thread works for none, nobody hears of it. Not for
// loops, whose order would be the threads'.
void warn(const std::string& sentence);

// check_cancelled(), once in so many turns of a loop.
class CheckEvery {
 public:
  explicit CheckEvery(int turns) : turns_(turns), left_(turns) {}
  void operator()() {
    if (--left_ > 0) return;
    left_ = turns_;
    check_cancelled();
  }

 private:
  int turns_, left_;
};

// std::sort that looks on its way. What was sorted is left in disorder if it throws.
template <typename Iterator, typename Less>
void sort_unless_cancelled(Iterator begin, Iterator end, Less less) {
  CheckEvery check(1 << 15);
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    check();
    return less(a, b);
  });
}

}  // namespace hydrodip
