#include "base/awake_threads.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>

#include "base/parallel.h"
#include "base/whole_loop.h"

namespace hydrodip {
namespace {

using fixtures::expect_whole_loop;

TEST(AwakeThreads, ShareManyShortLoops) {
  const AwakeThreads awake;
  for (int repeat = 0; repeat < 2000; ++repeat)
    for (const std::size_t count : {0, 1, 10, 11, 95}) expect_whole_loop(count);
}

TEST(AwakeThreads, TakePartInLoops) {
  if (available_threads() < 2) GTEST_SKIP() << "one thread";
  const AwakeThreads awake;
  // Two chunks that wait for each other need two threads.
  std::atomic<int> met = 0;
  std::set<std::thread::id> who[2];
  parallel_for(2, 1, [&](std::size_t begin, std::size_t) {
    ++met;
    while (met < 2) std::this_thread::yield();
    who[begin].insert(std::this_thread::get_id());
  });
  EXPECT_NE(who[0], who[1]);
}

TEST(AwakeThreads, WakeUpAgain) {
  const AwakeThreads awake;
  for (int repeat = 0; repeat < 5; ++repeat) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    expect_whole_loop(1000);
  }
}

TEST(AwakeThreads, LoopsMayHoldLoops) {
  const AwakeThreads awake;
  std::atomic<int> visits = 0;
  parallel_for(20, 1, [&](std::size_t, std::size_t) {
    const AwakeThreads of_its_own;
    parallel_for(20, 1, [&](std::size_t, std::size_t) { ++visits; });
  });
  EXPECT_EQ(visits, 400);
}

TEST(AwakeThreads, RethrowAndGoOn) {
  const AwakeThreads awake;
  for (int repeat = 0; repeat < 200; ++repeat) {
    EXPECT_THROW(parallel_for(40, 1,
                              [&](std::size_t begin, std::size_t) {
                                if (begin == 17) throw std::runtime_error("17");
                              }),
                 std::runtime_error);
    expect_whole_loop(50);
  }
}

TEST(AwakeThreads, ServeSeveralOwners) {
  std::array<std::thread, 4> owners;
  for (std::thread& owner : owners)
    owner = std::thread([] {
      for (int repeat = 0; repeat < 20; ++repeat) {
        const AwakeThreads awake;
        for (int loop = 0; loop < 50; ++loop) expect_whole_loop(95);
      }
    });
  for (std::thread& owner : owners) owner.join();
}

TEST(AwakeThreads, OneThreadNeedsNone) {
  const ThreadLimit one(1);
  const AwakeThreads awake;
  EXPECT_FALSE(run_awake(3, [](std::size_t) {}));
  expect_whole_loop(95);
}

}  // namespace
}  // namespace hydrodip
