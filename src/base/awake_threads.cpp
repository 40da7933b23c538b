#include "base/awake_threads.h"

#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <system_error>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "base/thread_supply.h"
#include "base/work.h"

namespace hydrodip {

namespace {

using Clock = std::chrono::steady_clock;
using Time = std::chrono::nanoseconds;

// Looks for a loop before a thread falls asleep: some tenths of a millisecond.
constexpr int kLooksAwake = 20000;
// More than share memory well, and than loops of ten microseconds have parts for.
constexpr int kMostThreads = 8;
// Looks for the last chunk of a loop before its owner asks what holds it up: some tens of
// microseconds.
constexpr int kLooksForStragglers = 1000;
// A thread that was without a core for so long while others waited for it had lost it to another
// process.
constexpr Time kLostCore = std::chrono::microseconds(100);
// Where more than so much of a window is lost that way, sharing loops costs more than it gains: two
// threads are at most twice as fast as one.
constexpr Time kWindow = std::chrono::milliseconds(30), kMostLost = kWindow / 3;
// Then loops run without others for so many times what was lost; and for twice as long as before
// where sharing does not last longer than that in between. So busy machines cost little, and one
// that is busy no longer is found out within a second.
constexpr int kAlonePerLoss = 10;
constexpr Time kLongestAlone = std::chrono::milliseconds(500);

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

// One loop at a time, shared by the thread that owns it and those that serve it.
class SharedLoops {
 public:
  explicit SharedLoops(int threads) : parts_(std::size_t(threads)) {
    try {
      for (std::size_t part = 1; part < parts_.size(); ++part)
        servers_.emplace_back([this, part] { serve(parts_[part], part); });
    } catch (const std::system_error&) {  // the system gives no more threads: fewer will do
    }
  }

  ~SharedLoops() {
    open_loop_ = kClosed;
    open_loop_.notify_all();
    for (std::thread& server : servers_) server.join();
  }

  // By the owner, outside of any loop.
  void run(std::size_t chunks, const std::function<void(std::size_t)>& body) {
    if (is_alone()) {
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) body(chunk);
      return;
    }
    body_ = &body;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      parts_[p].next.store(chunks * p / parts_.size(), std::memory_order_relaxed);
      parts_[p].end = chunks * (p + 1) / parts_.size();
    }
    if (++last_loop_ < kFirst) last_loop_ = kFirst;
    open_loop_ = last_loop_;
    if (asleep_ > 0) open_loop_.notify_all();
    work(0);
    open_loop_ = kNone;
    for (int look = 0; inside_ > 0; ++look) {
      if (look == kLooksForStragglers) return wait_for_stragglers();
      pause();
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0, kClosed = 1, kFirst = 2;

  // Chunks of the loop that one thread begins with and the others help to finish.
  struct alignas(64) Part {
    std::atomic<std::size_t> next = 0;
    std::size_t end = 0;
    std::atomic<bool> inside = false;  // whether its thread is in a loop
  };

  void serve(Part& own, std::size_t part) {
    std::uint32_t done = kNone;
    while (true) {
      const std::uint32_t loop = wait_for_loop(done);
      if (loop == kClosed) return;
      own.inside.store(true, std::memory_order_relaxed);
      ++inside_;
      // The owner waits for those inside only after it has closed the loop.
      if (open_loop_ == loop) work(part);
      own.inside.store(false, std::memory_order_relaxed);
      if (--inside_ == 0 && owner_sleeps_) inside_.notify_one();
      done = loop;
    }
  }

  std::uint32_t wait_for_loop(std::uint32_t done) {
    for (int look = 0;; ++look) {
      const std::uint32_t loop = open_loop_;
      if (loop != kNone && loop != done) return loop;
      if (look < kLooksAwake && !alone_.load(std::memory_order_relaxed)) {
        pause();
        continue;
      }
      ++asleep_;
      open_loop_.wait(loop);
      --asleep_;
      look = 0;
    }
  }

  void work(std::size_t first) {
    for (std::size_t n = 0; n < parts_.size(); ++n) {
      Part& part = parts_[(first + n) % parts_.size()];
      for (std::size_t chunk = part.next++; chunk < part.end; chunk = part.next++) (*body_)(chunk);
    }
  }

  bool is_alone() {
    if (!alone_.load(std::memory_order_relaxed)) return false;
    const Clock::time_point now = Clock::now();
    if (now < alone_until_) return true;
    alone_ = false;
    shared_since_ = window_ = now;
    lost_ = Time(0);
    return false;
  }

  void note_loss(Clock::time_point begin, Clock::time_point end, Time lost) {
    if (lost < kLostCore) return;
    if (begin - window_ > kWindow) {
      window_ = begin;
      lost_ = Time(0);
    }
    lost_ += lost;
    if (lost_ < kMostLost) return;
    const bool again = begin - shared_since_ < alone_for_;
    alone_for_ = std::min(again ? 2 * alone_for_ : kAlonePerLoss * lost_, kLongestAlone);
    alone_until_ = end + alone_for_;
    alone_ = true;
  }

  // Sleeps, so that others may have this core, and finds out whether those it waits for had theirs.
  void wait_for_stragglers() {
    const std::vector<Time> had = processor_times();
    std::vector<std::uint8_t> inside;
    for (std::size_t s = 0; s < servers_.size(); ++s) inside.push_back(parts_[s + 1].inside);
    const Clock::time_point start = Clock::now();
    owner_sleeps_ = true;
    for (int n = inside_; n > 0; n = inside_) inside_.wait(n);
    owner_sleeps_ = false;
    const Clock::time_point end = Clock::now();
    const std::vector<Time> have = processor_times();
    Time lost{0};
    for (std::size_t s = 0; s < servers_.size(); ++s)
      if (inside[s]) lost = std::max(lost, end - start - (have[s] - had[s]));
    note_loss(start, end, lost);
  }

  // That each server has used so far.
  std::vector<Time> processor_times() {
    std::vector<Time> times;
    for (std::thread& server : servers_) {
      clockid_t clock{};
      timespec time{};
      if (pthread_getcpuclockid(server.native_handle(), &clock) == 0) clock_gettime(clock, &time);
      times.push_back(std::chrono::seconds(time.tv_sec) + Time(time.tv_nsec));
    }
    return times;
  }

  std::vector<Part> parts_;  // the first is the owner's, the others those of servers_
  const std::function<void(std::size_t)>* body_ = nullptr;
  std::uint32_t last_loop_ = kClosed;
  // Of the owner's: when loops began to be shared, and in a window since then, how much was lost.
  Clock::time_point shared_since_ = Clock::now(), window_ = shared_since_;
  Time lost_{0};
  Time alone_for_{0};  // the last time
  Clock::time_point alone_until_;
  alignas(64) std::atomic<std::uint32_t> open_loop_ = kNone;
  alignas(64) std::atomic<int> inside_ = 0;
  std::atomic<bool> owner_sleeps_ = false;
  std::atomic<int> asleep_ = 0;
  std::atomic<bool> alone_ = false;  // the owner, and so nobody has to stay awake
  std::vector<std::thread> servers_;
};

AwakeThreads::AwakeThreads() {
  // Threads that wait awake must not take turns on a core.
  const int threads = std::min({available_threads(), threads_in_supply(), kMostThreads});
  if (work_here.in_loop || work_here.awake != nullptr || threads < 2) return;
  loops_ = std::make_unique<SharedLoops>(threads);
  work_here.awake = loops_.get();
}

AwakeThreads::~AwakeThreads() {
  if (loops_) work_here.awake = nullptr;
}

bool run_awake(std::size_t chunks, const std::function<void(std::size_t)>& run) {
  if (work_here.awake == nullptr) return false;
  work_here.awake->run(chunks, run);
  return true;
}

}  // namespace hydrodip
