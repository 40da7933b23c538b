#include "calibrate/simulations.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>

#include "base/error.h"
#include "base/parallel.h"

namespace hydrodip {
namespace {

// Whether the job was cancelled.
constexpr std::chrono::milliseconds kLookEvery{20};

// Runs tasks 0 .. count - 1 on so many threads of its own, each a quiet part of the job. `done` is
// called for each on the calling thread.
class Crew {
 public:
  explicit Crew(const RunContext& context) : workers_context_(context.with_threads(1).quiet()) {}

  using Task = std::function<void(std::size_t index, const RunContext& context)>;
  using Done = std::function<void(std::size_t index)>;

  void run(std::size_t count, int threads, const Task& task, const Done& done,
           const RunContext& context) {
    std::vector<std::thread> workers;
    const auto size = std::min(count, std::size_t(std::max(1, threads)));
    try {
      for (std::size_t i = 0; i < size; ++i) workers.emplace_back([&] { work(count, task); });
    } catch (const std::system_error&) {  // the system gives no more threads: fewer will do
      if (workers.empty()) throw;
    }
    std::exception_ptr failure;
    try {
      collect(count, done, context);
    } catch (...) {
      failure = std::current_exception();
    }
    stop();
    for (std::thread& worker : workers) worker.join();
    if (!failure) failure = failure_;
    if (failure) std::rethrow_exception(failure);
  }

 private:
  void work(std::size_t count, const Task& task) {
    const RunScope scope(workers_context_);
    for (std::size_t i = next_++; i < count; i = next_++) {
      try {
        task(i, workers_context_);
        const std::lock_guard lock(mutex_);
        finished_.push_back(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        next_ = count;
      }
      changed_.notify_one();
    }
  }

  void collect(std::size_t count, const Done& done, const RunContext& context) {
    std::size_t seen = 0;
    while (seen < count) {
      std::vector<std::size_t> batch;
      {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kLookEvery, [&] { return failure_ || !finished_.empty(); });
        if (failure_) return;
        batch.swap(finished_);
      }
      for (const std::size_t i : batch) done(i);
      seen += batch.size();
      context.check_cancelled();
    }
  }

  void stop() {
    next_ = std::size_t(1) << 62;
    workers_context_.cancel();
  }

  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::size_t> finished_;
  std::exception_ptr failure_;
  RunContext workers_context_;
};

}  // namespace

Simulations::Simulations(const std::vector<Subject>& subjects, const DesignOptions& design,
                         const Board& board, const std::string& level, SimulationStore& store)
    : Simulations(subjects, design, checkered_film(design, board), level, store) {}

Simulations::Simulations(const std::vector<Subject>& subjects, const DesignOptions& design,
                         CheckeredFilm film, const std::string& level, SimulationStore& store)
    : subjects_(subjects), design_(design), film_(std::move(film)), level_(level), store_(store) {}

SimulationKey Simulations::key_of(const SimulationRequest& request) const {
  return {subjects_[request.subject].fingerprint + "-" + level_, request.parameters};
}

SimulationResult Simulations::compute(const SimulationRequest& request,
                                      const RunContext& context) const {
  const Subject& subject = subjects_[request.subject];
  try {
    const CheckerboardDip dip = dip_checkerboard(film_, subject.object, *subject.surface,
                                                 request.parameters, design_.dip, context);
    return landings_of(dip, subject.object, reach_of(design_.film, film_.board.square_mm));
  } catch (const DipError&) {
    return std::nullopt;
  }
}

std::size_t Simulations::missing(const std::vector<SimulationRequest>& requests) const {
  std::set<SimulationKey> keys;
  for (const SimulationRequest& request : requests)
    if (store_.find(key_of(request)) == nullptr) keys.insert(key_of(request));
  return keys.size();
}

std::vector<SimulationResult> Simulations::get(const std::vector<SimulationRequest>& requests,
                                               const std::string& activity,
                                               const RunContext& context) {
  std::vector<SimulationRequest> todo;
  std::set<SimulationKey> listed;
  for (const SimulationRequest& request : requests)
    if (store_.find(key_of(request)) == nullptr && listed.insert(key_of(request)).second)
      todo.push_back(request);

  if (!todo.empty()) {
    const int threads = available_threads();
    std::vector<SimulationResult> computed(todo.size());
    std::size_t done = 0;
    context.progress(activity, 0);
    Crew(context).run(
        todo.size(), threads,
        [&](std::size_t i, const RunContext& quiet) { computed[i] = compute(todo[i], quiet); },
        [&](std::size_t i) {
          store_.add(key_of(todo[i]), computed[i]);
          computed[i].reset();
          context.progress(activity, double(++done) / double(todo.size()));
        },
        context);
  }
  std::vector<SimulationResult> results;
  results.reserve(requests.size());
  for (const SimulationRequest& request : requests)
    results.push_back(*store_.find(key_of(request)));
  return results;
}

}  // namespace hydrodip
