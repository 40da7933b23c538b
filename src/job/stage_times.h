// How long each stage of a job took, and the memory at its highest.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace hydrodip {

struct StageTime {
  std::string stage;
  double seconds = 0;
};

class StageTimes {
 public:
  // Runs work() and records how long it took; returns what it returns.
  template <class Work>
  auto measure(const std::string& stage, Work&& work) {
    const Timer timer(*this, stage);
    return std::forward<Work>(work)();
  }

  const std::vector<StageTime>& list() const { return list_; }
  double total_s() const { return seconds_since(start_); }

 private:
  using Clock = std::chrono::steady_clock;

  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  class Timer {
   public:
    Timer(StageTimes& times, std::string stage)
        : times_(times), stage_(std::move(stage)), start_(Clock::now()) {}
    ~Timer() { times_.list_.push_back({std::move(stage_), seconds_since(start_)}); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    StageTimes& times_;
    std::string stage_;
    Clock::time_point start_;
  };

  std::vector<StageTime> list_;
  Clock::time_point start_ = Clock::now();
};

// Largest resident set of this process so far.
std::size_t peak_memory_bytes();

}  // namespace hydrodip
