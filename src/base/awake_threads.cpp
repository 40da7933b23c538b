#include "base/awake_threads.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace hydrodip {

namespace {

// Looks for a loop before a thread falls asleep: some tenths of a millisecond.
constexpr int kLooksAwake = 20000;
// More than share memory well, and than loops of ten microseconds have parts for.
constexpr int kMostThreads = 8;

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
  explicit SharedLoops(int threads) : parts_(std::size_t(threads)) {}

  // By the owner. False if a loop is running: this one is inside it.
  bool run(std::size_t chunks, const std::function<void(std::size_t)>& body) {
    if (body_) return false;
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
    while (inside_ > 0) pause();
    body_ = nullptr;
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return true;
  }

  // By the owner: threads that serve leave, and none begins to.
  void close() {
    open_loop_ = kClosed;
    open_loop_.notify_all();
  }

  // By any other thread, until the owner closes.
  void serve() {
    const std::size_t part = ++servers_;
    std::uint32_t done = kNone;
    while (true) {
      const std::uint32_t loop = wait_for_loop(done);
      if (loop == kClosed) return;
      ++inside_;
      // The owner waits for those inside only after it has closed the loop.
      if (open_loop_ == loop) work(part);
      --inside_;
      done = loop;
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0, kClosed = 1, kFirst = 2;

  // Chunks of the loop that one thread begins with and the others help to finish.
  struct alignas(64) Part {
    std::atomic<std::size_t> next = 0;
    std::size_t end = 0;
  };

  std::uint32_t wait_for_loop(std::uint32_t done) {
    for (int look = 0;; ++look) {
      const std::uint32_t loop = open_loop_;
      if (loop != kNone && loop != done) return loop;
      if (look < kLooksAwake) {
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
      for (std::size_t chunk = part.next++; chunk < part.end; chunk = part.next++) {
        try {
          (*body_)(chunk);
        } catch (...) {
          const std::lock_guard lock(failure_lock_);
          if (!failure_) failure_ = std::current_exception();
        }
      }
    }
  }

  std::vector<Part> parts_;
  const std::function<void(std::size_t)>* body_ = nullptr;
  std::uint32_t last_loop_ = kClosed;
  alignas(64) std::atomic<std::uint32_t> open_loop_ = kNone;
  alignas(64) std::atomic<int> inside_ = 0;
  std::atomic<int> asleep_ = 0;
  std::atomic<std::size_t> servers_ = 0;
  std::mutex failure_lock_;
  std::exception_ptr failure_;
};

namespace {

thread_local SharedLoops* own_loops = nullptr;

// The owners that still want threads. Tasks that call threads here hold nothing: those that find
// none to serve, or are never run, leave nothing behind.
class Wanted {
 public:
  void add(const std::shared_ptr<SharedLoops>& loops, int threads) {
    const std::lock_guard lock(lock_);
    for (int n = 0; n < threads; ++n) wanted_.push_back(loops);
  }
  void remove(const std::shared_ptr<SharedLoops>& loops) {
    const std::lock_guard lock(lock_);
    std::erase(wanted_, loops);
  }
  void serve_one() {
    std::shared_ptr<SharedLoops> loops;
    {
      const std::lock_guard lock(lock_);
      if (wanted_.empty()) return;
      loops = std::move(wanted_.back());
      wanted_.pop_back();
    }
    loops->serve();
  }

 private:
  std::mutex lock_;
  std::vector<std::shared_ptr<SharedLoops>> wanted_;
};

// Never destroyed: a thread may still ask while the process ends.
Wanted& wanted() {
  static Wanted& all = *new Wanted;
  return all;
}

}  // namespace

AwakeThreads::AwakeThreads() {
  // Threads that wait awake must not take turns on a core.
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int threads = std::min({available_threads(), cores, kMostThreads});
  if (own_loops || threads < 2) return;
  loops_ = std::make_shared<SharedLoops>(threads);
  own_loops = loops_.get();
  // An arena of their own: a thread that waits for other work must not begin to serve.
  tbb::task_arena arena(threads);
  wanted().add(loops_, threads - 1);
  for (int n = 1; n < threads; ++n) arena.enqueue([] { wanted().serve_one(); });
}

AwakeThreads::~AwakeThreads() {
  if (!loops_) return;
  wanted().remove(loops_);
  loops_->close();
  own_loops = nullptr;
}

bool run_awake(std::size_t chunks, const std::function<void(std::size_t)>& run) {
  return own_loops && own_loops->run(chunks, run);
}

}  // namespace hydrodip
