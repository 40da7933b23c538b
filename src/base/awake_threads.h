// Threads that wait awake for loops, so that even loops of ten microseconds are worth sharing.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace hydrodip {

class SharedLoops;

// While it lives, threads of its own wait for parallel_for's loops on the thread that made it, as
// many as the job there may use. Each begins with the part of a loop with which it began the loop
// before: what belongs to one part of a field stays in one core's cache. For long successions of
// short loops. Threads that find nothing to do for a while sleep. Where other processes want the
// cores too, loops run without them for most of the time: a thread that has lost its core in the
// midst of a chunk holds up all others.
class AwakeThreads {
 public:
  AwakeThreads();
  ~AwakeThreads();
  AwakeThreads(const AwakeThreads&) = delete;
  AwakeThreads& operator=(const AwakeThreads&) = delete;

 private:
  std::unique_ptr<SharedLoops> loops_;  // none: one thread, in a loop, or there are some already
};

// Calls run(chunk), which throws nothing, for all of [0, chunks) with this thread's awake threads,
// and returns true, or false if it has none.
bool run_awake(std::size_t chunks, const std::function<void(std::size_t chunk)>& run);

}  // namespace hydrodip
