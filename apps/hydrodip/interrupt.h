// Ctrl-C: the first cancels the job in good order, the second ends the program at once (the third,
// where the job has to stop a machine on the second).
#pragma once

#include "base/context.h"

namespace hydrodip {

// While it lives, SIGINT, SIGTERM and SIGHUP cancel `context`. One at a time.
class CancelOnInterrupt {
 public:
  explicit CancelOnInterrupt(const RunContext& context);
  ~CancelOnInterrupt();
  CancelOnInterrupt(const CancelOnInterrupt&) = delete;
  CancelOnInterrupt& operator=(const CancelOnInterrupt&) = delete;
};

constexpr int kExitCancelled = 130;

}  // namespace hydrodip
