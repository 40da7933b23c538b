#pragma once

#include <memory>
#include <string>
#include <vector>

#include "job/computed.h"

namespace hydrodip::python {

// A dip that was computed, and what led to it. All of it is shared and never changes.
struct Simulation {
  std::shared_ptr<const ReadyJob> job;
  DippedObject dipped;
  std::shared_ptr<const Finish> finish;
  std::vector<std::string> warnings;
};

struct Design : Simulation {
  std::shared_ptr<const Designed> designed;
};

}  // namespace hydrodip::python
