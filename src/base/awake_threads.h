// Threads that wait awake for loops, so that even loops of ten microseconds are worth sharing.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace hydrodip {

class SharedLoops;

// While it lives, threads wait for parallel_for's loops on the thread that made it. Each begins
// with the part of a loop with which it began the loop before: what belongs to one part of a field
// stays in one core's cache. For long successions of short loops. Threads that find nothing to do
// for a while sleep; while none is to be had, loops run without them.
class AwakeThreads {
 public:
  AwakeThreads();
  ~AwakeThreads();
  AwakeThreads(const AwakeThreads&) = delete;
  AwakeThreads& operator=(const AwakeThreads&) = delete;

 private:
  std::shared_ptr<SharedLoops> loops_;  // none: there is one thread, or another's are used
};

// Calls run(chunk) for all of [0, chunks) with this thread's awake threads, and returns true, or
// false if it has none or they are at work. The first exception is rethrown.
bool run_awake(std::size_t chunks, const std::function<void(std::size_t chunk)>& run);

}  // namespace hydrodip
