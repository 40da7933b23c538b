#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace hydrodip {

double memory_limit_bytes() {
  double least = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  // "max" where there is none, which is no number.
  double container = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> container && container > 0)
    least = std::min(least, container);
  return least;
}

double address_limit_bytes() {
  double least = std::numeric_limits<double>::infinity();
  for (const int kind : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (getrlimit(kind, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      least = std::min(least, double(limit.rlim_cur));
  }
  return least;
}

}  // namespace hydrodip
