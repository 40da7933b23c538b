// So many threads of the processor for one job: the only place that knows TBB.
#pragma once

#include <cstddef>

namespace hydrodip {

// How many threads the processor runs at once, as far as this process may use them.
int processor_threads();

// From now on, and for the whole process, no loop uses any thread but its own: neither ours nor a
// library's that runs on TBB.
void stay_on_one_thread();

// A loop over chunks, in plain types: thread_budget.cpp is compiled apart (see there).
struct ChunkLoop {
  // Throws nothing.
  void (*run)(const ChunkLoop& loop, std::size_t chunk);
  std::size_t chunks;
};

class ThreadBudget {
 public:
  // threads > 0.
  explicit ThreadBudget(int threads);
  ~ThreadBudget();
  ThreadBudget(const ThreadBudget&) = delete;
  ThreadBudget& operator=(const ThreadBudget&) = delete;

  int threads() const { return threads_; }

  // Runs each chunk once, on these threads, the caller among them. Callable from any thread, also
  // inside a loop.
  void run(const ChunkLoop& loop);

 private:
  int threads_;
  void* arena_;  // an Arena of thread_budget.cpp's
};

// The same with all of the processor's threads.
void run_on_all_threads(const ChunkLoop& loop);

}  // namespace hydrodip
