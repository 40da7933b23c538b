// Debian's TBB is not built for ThreadSanitizer, which therefore sees none of what TBB does to hand
// memory from thread to thread. With that sanitizer this file is compiled without it: its checks
// begin and end at ChunkLoop::run, where parallel.cpp says what is handed over. No types of the
// standard library are used here, so that none of its functions are taken from here for others.
#include "base/thread_budget.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/spin_mutex.h>
#include <oneapi/tbb/task_arena.h>

namespace hydrodip {

namespace {

// Threads that work together. TBB 2021.8, Debian's, loses 6 to 8 kB with every arena that ends
// after others have worked in it, and a thread that shares a loop outside of any has an arena of
// its own, which ends with it. So arenas never end here: loops and budgets take them in turn, and
// there are as many as were ever needed at once.
class Arena {
 public:
  static Arena* take(int threads) {
    {
      const tbb::spin_mutex::scoped_lock lock(idle_mutex());
      for (Arena** at = &idle_; *at != nullptr; at = &(*at)->next_) {
        if ((*at)->threads_ != threads) continue;
        Arena* found = *at;
        *at = found->next_;
        return found;
      }
    }
    return new Arena(threads);
  }

  void give_back() {
    const tbb::spin_mutex::scoped_lock lock(idle_mutex());
    next_ = idle_;
    idle_ = this;
  }

  void run(const ChunkLoop& loop) {
    arena_.execute([&loop] { run_here(loop); });
  }

  // In the arena where this thread is.
  static void run_here(const ChunkLoop& loop) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, loop.chunks, 1),
        [&loop](const tbb::blocked_range<std::size_t>& range) {
          ++inside_;
          for (std::size_t c = range.begin(); c != range.end(); ++c) loop.run(loop, c);
          --inside_;
        },
        tbb::simple_partitioner());
  }
  static bool is_inside() { return inside_ > 0; }

 private:
  explicit Arena(int threads) : threads_(threads), arena_(threads) {}

  static tbb::spin_mutex& idle_mutex() {
    static tbb::spin_mutex mutex;
    return mutex;
  }

  static Arena* idle_;
  static thread_local int inside_;  // chunks of loops in which this thread is

  int threads_;
  tbb::task_arena arena_;
  Arena* next_ = nullptr;
};

constinit Arena* Arena::idle_ = nullptr;
constinit thread_local int Arena::inside_ = 0;

}  // namespace

int processor_threads() { return tbb::info::default_concurrency(); }

void stay_on_one_thread() {
  static const tbb::global_control& one =
      *new tbb::global_control(tbb::global_control::max_allowed_parallelism, 1);
  static_cast<void>(one);
}

ThreadBudget::ThreadBudget(int threads) : threads_(threads), arena_(Arena::take(threads)) {}

ThreadBudget::~ThreadBudget() { static_cast<Arena*>(arena_)->give_back(); }

void ThreadBudget::run(const ChunkLoop& loop) { static_cast<Arena*>(arena_)->run(loop); }

void run_on_all_threads(const ChunkLoop& loop) {
  if (Arena::is_inside()) return Arena::run_here(loop);
  Arena* const arena = Arena::take(processor_threads());
  arena->run(loop);
  arena->give_back();
}

}  // namespace hydrodip
