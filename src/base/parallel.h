// Data-parallel loops whose result cannot depend on the number of threads: every index is
// independent, and whoever sums results does so afterwards in index order.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace hydrodip {

// Chunks for loops over triangles or vertices with little work each: large enough that handing them
// out costs nothing.
inline constexpr std::size_t kElementGrain = 2048;

// Calls body(begin, end) on disjoint chunks that together cover [0, count), on any thread.
// Chunk limits are fixed multiples of grain, whatever the number of threads. The first exception
// is rethrown.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

// Runs all of them, on any threads, and returns when all are done or have failed. Of several
// exceptions the first in the list's order is rethrown.
void parallel_do(const std::vector<std::function<void()>>& tasks);

// How many threads parallel_for may use now.
int available_threads();

// While it lives, parallel_for uses at most this many threads (0: all cores).
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_ = nullptr;
};

}  // namespace hydrodip
