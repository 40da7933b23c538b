#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>

#include "base/awake_threads.h"
#include "base/thread_budget.h"
#include "base/thread_supply.h"

namespace hydrodip {

namespace {

// A loop's chunks as other threads see them.
class SharedLoop : public ChunkLoop {
 public:
  SharedLoop(std::size_t count, std::size_t grain,
             const std::function<void(std::size_t, std::size_t)>& body)
      : ChunkLoop{&SharedLoop::run_handed_over, (count + grain - 1) / grain},
        count_(count),
        grain_(grain),
        body_(body),
        work_{work_here.context, work_here.budget, nullptr, true} {}

  // On any thread.
  void run_chunk(std::size_t chunk) {
    // What comes after the first failure would change nothing. What comes before it may fail first.
    if (chunk >= first_failed_.load(std::memory_order_relaxed)) return;
    const AtWork at_work(work_);
    try {
      check_cancelled();
      body_(chunk * grain_, std::min(count_, (chunk + 1) * grain_));
    } catch (...) {
      const std::lock_guard lock(failing_);
      if (chunk >= first_failed_) return;
      first_failed_ = chunk;
      failure_ = std::current_exception();
    }
  }

  void run_on_the_budget() {
    handed_over_.store(0, std::memory_order_release);
    if (work_here.budget != nullptr)
      work_here.budget->run(*this);
    else
      run_on_all_threads(*this);
    handed_over_.load(std::memory_order_acquire);
  }

  void rethrow() {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

 private:
  // TBB orders the caller, the chunks and what follows the loop. It is said here once more, for
  // ThreadSanitizer, which cannot see into TBB; next to a chunk it costs nothing.
  static void run_handed_over(const ChunkLoop& loop, std::size_t chunk) {
    auto& self = const_cast<SharedLoop&>(static_cast<const SharedLoop&>(loop));
    self.handed_over_.load(std::memory_order_acquire);
    self.run_chunk(chunk);
    self.handed_over_.fetch_add(1, std::memory_order_release);
  }

  const std::size_t count_, grain_;
  const std::function<void(std::size_t, std::size_t)>& body_;
  const Work work_;
  std::atomic<std::size_t> handed_over_{0};
  std::atomic<std::size_t> first_failed_{std::numeric_limits<std::size_t>::max()};
  std::mutex failing_;
  std::exception_ptr failure_;
};

}  // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (count == 0) return;
  if (count <= grain) {
    check_cancelled();
    body(0, count);
    return;
  }
  if (available_threads() == 1) {
    for (std::size_t begin = 0; begin < count; begin += grain) {
      check_cancelled();
      body(begin, std::min(count, begin + grain));
    }
    return;
  }
  SharedLoop loop(count, grain, body);
  const auto run = [&](std::size_t chunk) { loop.run_chunk(chunk); };
  if (!run_awake(loop.chunks, std::cref(run))) loop.run_on_the_budget();
  loop.rethrow();
}

void parallel_do(const std::vector<std::function<void()>>& tasks) {
  std::vector<std::exception_ptr> failures(tasks.size());
  parallel_for(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      try {
        tasks[n]();
      } catch (...) {
        failures[n] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

int available_threads() {
  return work_here.budget != nullptr ? work_here.budget->threads() : threads_in_supply();
}

ThreadLimit::ThreadLimit(int threads)
    : scope_((work_here.context != nullptr ? *work_here.context : RunContext())
                 .with_threads(threads)) {}

}  // namespace hydrodip
