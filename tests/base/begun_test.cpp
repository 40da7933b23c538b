#include "base/begun.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace hydrodip {
namespace {

using namespace std::chrono_literals;

TEST(Begun, GoesOnWhileItsCallerDoesSomethingElse) {
  if (available_threads() < 2) GTEST_SKIP() << "one thread";
  std::atomic<bool> caller_has_gone_on = false, is_at_work = false;
  Begun<bool> work([&] {
    is_at_work = true;
    for (int n = 0; n < 10000 && !caller_has_gone_on; ++n) std::this_thread::sleep_for(1ms);
    return caller_has_gone_on.load();
  });
  for (int n = 0; n < 10000 && !is_at_work; ++n) std::this_thread::sleep_for(1ms);
  EXPECT_TRUE(is_at_work);
  caller_has_gone_on = true;
  EXPECT_TRUE(work.take());
}

TEST(Begun, IsDoneByWhoWaitsWhereOneThreadIsAllThereIs) {
  const auto on_own_thread = [] {
    Begun<std::thread::id> work([] { return std::this_thread::get_id(); });
    return work.take() == std::this_thread::get_id();
  };
  {
    const RunScope one(RunContext().with_threads(1));
    EXPECT_TRUE(on_own_thread());
  }
  std::atomic<int> own = 0;
  parallel_for(100, 1, [&](std::size_t, std::size_t) { own += on_own_thread() ? 1 : 0; });
  EXPECT_EQ(own, 100);  // all threads are at work there
}

TEST(Begun, TakesNoMoreThreadsThanTheJobMayUse) {
  for (const int most : {1, 2, available_threads()}) {
    const RunScope scope(RunContext().with_threads(most));
    std::atomic<int> now = 0, ever = 0;
    std::vector<std::unique_ptr<BegunWork>> begun;
    begun.reserve(std::size_t(2 * most + 3));
    for (int n = 0; n < 2 * most + 3; ++n)
      begun.push_back(std::make_unique<BegunWork>([&] {
        const int here = ++now;
        for (int seen = ever; seen < here && !ever.compare_exchange_weak(seen, here);) {
        }
        std::this_thread::sleep_for(2ms);
        --now;
      }));
    std::this_thread::sleep_for(5ms);
    EXPECT_LE(ever, std::max(0, most - 1));
    for (const auto& work : begun) work->wait();
    EXPECT_EQ(now, 0);
  }
}

TEST(Begun, WarnsAndThrowsWhereItIsTaken) {
  for (const int threads : {0, 1}) {
    const RunContext context = RunContext().with_threads(threads);
    const RunScope scope(context);
    Begun<int> first([] {
      std::this_thread::sleep_for(2ms);
      warn("first");
      return 1;
    });
    Begun<int> second([]() -> int {
      warn("second");
      throw std::runtime_error("broken");
    });
    second.wait();
    EXPECT_TRUE(second.has_failed());
    EXPECT_TRUE(context.warnings().empty());
    warn("caller");
    EXPECT_EQ(first.take(), 1);
    EXPECT_THROW(second.take(), std::runtime_error);
    EXPECT_EQ(context.warnings(), (std::vector<std::string>{"caller", "first", "second"}));
  }
}

TEST(Begun, HearsThatTheJobIsCancelled) {
  const RunContext context;
  const RunScope scope(context);
  BegunWork work([] {
    for (int n = 0; n < 100000; ++n) {
      check_cancelled();
      std::this_thread::sleep_for(100us);
    }
  });
  context.cancel();
  EXPECT_THROW(work.finish(), Cancelled);
}

TEST(Begun, EndsWithItsWork) {
  if (available_threads() < 2) GTEST_SKIP() << "one thread";
  std::atomic<bool> done = false;
  {
    const BegunWork work([&] {
      std::this_thread::sleep_for(5ms);
      done = true;
    });
    EXPECT_TRUE(work.has_begun());
  }
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace hydrodip
