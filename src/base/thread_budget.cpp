// Debian's TBB is not built for ThreadSanitizer, which therefore sees none of what TBB does to hand
// memory from thread to thread. With that sanitizer this file is compiled without it: its checks
// begin and end at ChunkLoop::run, where parallel.cpp says what is handed over. No types of the
// standard library are used here, so that none of its functions are taken from here for others.
#include "base/thread_budget.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace hydrodip {

namespace {

void run_here(const ChunkLoop& loop) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, loop.chunks, 1),
      [&loop](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t c = range.begin(); c != range.end(); ++c) loop.run(loop, c);
      },
      tbb::simple_partitioner());
}

}  // namespace

int processor_threads() { return tbb::info::default_concurrency(); }

void stay_on_one_thread() {
  static const tbb::global_control& one =
      *new tbb::global_control(tbb::global_control::max_allowed_parallelism, 1);
  static_cast<void>(one);
}

ThreadBudget::ThreadBudget(int threads) : threads_(threads), arena_(new tbb::task_arena(threads)) {}

ThreadBudget::~ThreadBudget() { delete static_cast<tbb::task_arena*>(arena_); }

void ThreadBudget::run(const ChunkLoop& loop) {
  static_cast<tbb::task_arena*>(arena_)->execute([&loop] { run_here(loop); });
}

void run_on_all_threads(const ChunkLoop& loop) { run_here(loop); }

}  // namespace hydrodip
