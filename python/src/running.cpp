#include "running.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

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
  const RunContext context;
  Mailbox mailbox;
  if (!progress.is_none())
    context.on_progress(
        [&](const std::string& activity, double fraction) { mailbox.add(activity, fraction); });
  std::exception_ptr failure, raised;
  std::thread worker([&] {
    try {
      work(context);
    } catch (...) {
      failure = std::current_exception();
    }
    mailbox.close();
  });
  for (bool ended = false; !ended;) {
    std::vector<News> news;
    {
      const py::gil_scoped_release release;
      ended = mailbox.wait(news);
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
  worker.join();
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace hydrodip::python
