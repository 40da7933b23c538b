#include "base/begun.h"

#include <atomic>
#include <system_error>

#include "base/parallel.h"
#include "base/work.h"

namespace hydrodip {

namespace {

// In the whole process: many jobs together do not begin more than its processor runs at once.
std::atomic<int> threads_begun{0};

std::optional<RunContext> own_context() {
  if (work_here.context == nullptr) return {};
  return work_here.context->quiet();
}

}  // namespace

BegunWork::BegunWork(std::function<void()> work) : work_(std::move(work)), own_(own_context()) {
  if (work_here.in_loop) return;
  if (++threads_begun < available_threads()) {
    try {
      thread_ = std::thread([this] {
        run();
        --threads_begun;
      });
      return;
    } catch (const std::system_error&) {  // the system gives no more threads
    }
  }
  --threads_begun;
}

BegunWork::~BegunWork() {
  if (thread_.joinable()) thread_.join();
}

void BegunWork::wait() {
  if (thread_.joinable()) {
    thread_.join();
  } else if (!is_done_) {
    run();
  }
}

void BegunWork::finish() {
  wait();
  if (own_)
    for (const std::string& sentence : own_->warnings()) warn(sentence);
  if (failure_) std::rethrow_exception(failure_);
}

void BegunWork::run() {
  try {
    std::optional<RunScope> scope;
    if (own_) scope.emplace(*own_);
    work_();
  } catch (...) {
    failure_ = std::current_exception();
  }
  is_done_ = true;
}

}  // namespace hydrodip
