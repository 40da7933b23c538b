// As many threads as the system lets this process have.
#pragma once

#include <optional>

#include "base/parallel.h"

namespace hydrodip {

// While it lives, parallel loops use the threads that were to be had when it was made, and those
// are there already: a thread that cannot be started later would end the process. Under a limit on
// processes or memory that may be one.
class AffordableThreads {
 public:
  AffordableThreads();

 private:
  std::optional<ThreadLimit> limit_;
};

}  // namespace hydrodip
