#include "affordable_threads.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace hydrodip {
namespace {

// Keeps every thread that comes until all are there.
class Meeting {
 public:
  explicit Meeting(int expected) : missing_(expected) {}

  void come() {
    std::unique_lock lock(mutex_);
    if (--missing_ <= 0) all_here_.notify_all();
    all_here_.wait_for(lock, std::chrono::milliseconds(200), [&] { return missing_ <= 0; });
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

// Whether that many more threads can run at once.
bool can_start(int count) {
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

}  // namespace

AffordableThreads::AffordableThreads() {
  const int wanted = available_threads();
  if (wanted < 2) return;
  if (!can_start(wanted - 1)) {
    limit_.emplace(1);
    return;
  }
  Meeting meeting(wanted);
  parallel_for(std::size_t(wanted), 1, [&](std::size_t, std::size_t) { meeting.come(); });
}

}  // namespace hydrodip
