// How long each part of a job took, and the memory at its highest.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace hydrodip {

struct Timing {
  std::string what;
  double seconds = 0;
};

class Timings {
 public:
  // Runs work() and records how long it took; returns what it returns.
  template <class Work>
  auto measure(const std::string& what, Work&& work) {
    const Timer timer(*this, what);
    return std::forward<Work>(work)();
  }

  const std::vector<Timing>& list() const { return list_; }
  double total_s() const { return seconds_since(start_); }

 private:
  using Clock = std::chrono::steady_clock;

  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  class Timer {
   public:
    Timer(Timings& times, std::string what)
        : times_(times), what_(std::move(what)), start_(Clock::now()) {}
    ~Timer() { times_.list_.push_back({std::move(what_), seconds_since(start_)}); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    Timings& times_;
    std::string what_;
    Clock::time_point start_;
  };

  std::vector<Timing> list_;
  Clock::time_point start_ = Clock::now();
};

// Largest resident set of this process so far.
std::size_t peak_memory_bytes();

}  // namespace hydrodip
