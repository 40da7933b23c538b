#include "workers.h"

#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace hydrodip::python {

namespace {

class Workers;

// Does one piece of work after the other, until the process ends.
class Worker {
 public:
  explicit Worker(Workers& home) : home_(home) {
    std::thread([this] { work_on(); }).detach();
  }

  void start(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    next_ = std::move(work);
    changed_.notify_one();
  }

 private:
  [[noreturn]] void work_on();

  Workers& home_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> next_;
};

class Workers {
 public:
  void start(std::function<void()> work) { idle_one()->start(std::move(work)); }
  void rest(Worker* worker) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(worker);
  }

 private:
  Worker* idle_one() {
    const std::lock_guard lock(mutex_);
    if (process_ != ::getpid()) idle_.clear();
    process_ = ::getpid();
    if (idle_.empty()) return new Worker(*this);
    Worker* worker = idle_.back();
    idle_.pop_back();
    return worker;
  }

  std::mutex mutex_;
  std::vector<Worker*> idle_;
  pid_t process_ = ::getpid();
};

void Worker::work_on() {
  for (;;) {
    std::function<void()> work;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return bool(next_); });
      work = std::exchange(next_, nullptr);
    }
    work();
    work = nullptr;
    home_.rest(this);
  }
}

}  // namespace

void start_on_worker(std::function<void()> work) {
  // Never destroyed: at the end of the process its threads still wait.
  static Workers& workers = *new Workers;
  workers.start(std::move(work));
}

}  // namespace hydrodip::python
