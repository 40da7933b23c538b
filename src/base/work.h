// What the calling thread is at work on, for base/ alone: run_scope.h is how others see it.
#pragma once

#include "base/context.h"

namespace hydrodip {

class SharedLoops;
class ThreadBudget;

struct Work {
  const RunContext* context = nullptr;  // none: nobody's, which cannot be cancelled
  ThreadBudget* budget = nullptr;       // none: all of the processor's threads
  SharedLoops* awake = nullptr;         // threads that wait for this thread's loops; none: none
  bool in_loop = false;                 // inside one of the chunks of a loop
};

// Of each thread. It points to what lives on the stack of this one, or of the one whose loop it
// takes part in; so it holds nothing that outlives a job, and jobs do not see each other's.
inline constinit thread_local Work work_here;

// Takes on other work, and goes back to the former.
class AtWork {
 public:
  explicit AtWork(const Work& work) : before_(work_here) { work_here = work; }
  ~AtWork() { work_here = before_; }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  const Work before_;
};

}  // namespace hydrodip
