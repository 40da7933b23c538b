#include "base/thread_supply.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/thread_budget.h"

namespace hydrodip {

namespace {

// Besides TBB's: those that wait awake, and ended ones that the system still counts.
constexpr int kToSpare = 8;

// Keeps every thread that comes until all are there.
class Meeting {
 public:
  explicit Meeting(int expected) : missing_(expected) {}

  void come() {
    std::unique_lock lock(mutex_);
    if (--missing_ <= 0) all_here_.notify_all();
    all_here_.wait_for(lock, std::chrono::milliseconds(200), [&] { return missing_ <= 0; });
    missing_ = 0;  // who has not come by now is not waited for again
  }

  void dissolve() {
    const std::lock_guard lock(mutex_);
    missing_ = 0;
    all_here_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable all_here_;
  int missing_;
};

// Whether that many threads can run beside this one at once.
bool can_start_threads(int count) {
  std::vector<std::thread> threads;
  Meeting meeting(count + 1);
  bool all = true;
  try {
    threads.reserve(std::size_t(count));
    for (int i = 0; i < count; ++i) threads.emplace_back([&] { meeting.come(); });
  } catch (const std::exception&) {
    all = false;
  }
  meeting.dissolve();
  for (std::thread& thread : threads) thread.join();
  return all;
}

// A loop in which every thread of the processor's takes part.
struct Roll : ChunkLoop {
  explicit Roll(int threads) : ChunkLoop{&Roll::answer, std::size_t(threads)}, meeting(threads) {}
  // TBB orders all of this; it is said once more for ThreadSanitizer, as in parallel.cpp.
  static void answer(const ChunkLoop& loop, std::size_t) {
    const auto& roll = static_cast<const Roll&>(loop);
    roll.handed_over.load(std::memory_order_acquire);
    roll.meeting.come();
    roll.handed_over.fetch_add(1, std::memory_order_release);
  }
  mutable Meeting meeting;
  mutable std::atomic<int> handed_over{0};
};

int secure_threads() {
  const int wanted = processor_threads();
  if (wanted < 2) return 1;
  if (!can_start_threads(wanted - 1 + std::min(wanted, kToSpare))) {
    stay_on_one_thread();
    return 1;
  }
  Roll roll(wanted);
  roll.handed_over.store(0, std::memory_order_release);
  run_on_all_threads(roll);
  roll.handed_over.load(std::memory_order_acquire);
  return wanted;
}

}  // namespace

int threads_in_supply() {
  static const int threads = secure_threads();
  return threads;
}

}  // namespace hydrodip
