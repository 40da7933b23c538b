#include "running.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "workers.h"

namespace hydrodip::python {

namespace py = pybind11;

namespace {

// Signals are looked for that often.
constexpr std::chrono::milliseconds kLookAgain(10);

struct News {
  std::string activity;
  double fraction;
};

// What the work's thread and the waiting one share.
class Mailbox {
 public:
  // Of one activity only the last is kept.
  void add(const std::string& activity, double fraction) {
    const std::lock_guard lock(mutex_);
    if (!news_.empty() && news_.back().activity == activity)
      news_.back().fraction = fraction;
    else
      news_.push_back({activity, fraction});
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_one();
  }
  // Waits for something, but not for long. Returns whether the work has ended.
  bool wait(std::vector<News>& news) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLookAgain, [&] { return closed_ || !news_.empty(); });
    news.swap(news_);
    return closed_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<News> news_;
  bool closed_ = false;
};

}  // namespace

void run(const py::object& progress, const std::function<void(const RunContext&)>& work) {
  struct Run {
    Mailbox mailbox;
    std::exception_ptr failure;
  };
  const RunContext context;
  const auto shared = std::make_shared<Run>();  // the worker may leave it last
  if (!progress.is_none())
    context.on_progress([shared](const std::string& activity, double fraction) {
      shared->mailbox.add(activity, fraction);
    });
  start_on_worker([shared, context, &work] {
    try {
      work(context);
    } catch (...) {
      shared->failure = std::current_exception();
    }
    shared->mailbox.close();
  });
  std::exception_ptr raised;
  for (bool ended = false; !ended;) {
    std::vector<News> news;
    {
      const py::gil_scoped_release release;
      ended = shared->mailbox.wait(news);
    }
    if (raised) continue;
    try {
      for (const News& n : news) progress(n.activity, n.fraction);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (const py::error_already_set&) {
      raised = std::current_exception();
      context.cancel();
    }
  }
  if (raised) std::rethrow_exception(raised);
  if (shared->failure) std::rethrow_exception(std::exchange(shared->failure, nullptr));
}

}  // namespace hydrodip::python
