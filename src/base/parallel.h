// Data-parallel loops whose result cannot depend on the number of threads: every index is
// independent, and whoever sums results does so afterwards in index order.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/run_scope.h"

namespace hydrodip {

// Chunks for loops over triangles or vertices with little work each: large enough that handing them
// out costs nothing.
inline constexpr std::size_t kElementGrain = 2048;

// Calls body(begin, end) on disjoint chunks that together cover [0, count), on any of the threads
// that the job of the calling thread may use (RunScope). Chunk limits are fixed multiples of grain,
// whatever the number of threads. Of several exceptions that of the first chunk is rethrown.
// Throws Cancelled, without finishing, if the job was cancelled.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

// Runs all of them, on any threads, and returns when all are done or have failed. Of several
// exceptions the first in the list's order is rethrown.
void parallel_do(const std::vector<std::function<void()>>& tasks);

// How many threads parallel_for may use now.
int available_threads();

// While it lives, this thread's loops use at most this many threads (0: as many as before). For
// what has no context of its own.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);

 private:
  const RunScope scope_;
};

}  // namespace hydrodip
