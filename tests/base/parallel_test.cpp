#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "base/run_scope.h"
#include "base/whole_loop.h"

namespace hydrodip {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInFixedChunks) {
  for (const std::size_t count : {0, 1, 9, 10, 11, 1000}) fixtures::expect_whole_loop(count);
}

// Kilobytes, as the system counts them.
long resident_kb() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (word == "VmRSS:") break;
  long kb = 0;
  file >> kb;
  return kb;
}

// Who embeds the library may do every job on a thread of its own, day and night.
TEST(ParallelFor, NewThreadsLeaveNoMemoryBehind) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep what is freed";
#endif
  const auto on_new_threads = [](int count) {
    std::atomic<int> sum = 0;
    const auto loop = [&] {
      for (int again = 0; again < 10; ++again)
        parallel_for(100, 1, [&](std::size_t begin, std::size_t) { sum += int(begin % 2); });
    };
    for (int n = 0; n < count; ++n) {
      std::thread(loop).join();
      std::thread([&] {
        const RunScope scope(RunContext().with_threads(available_threads() > 2 ? 2 : 0));
        loop();
      }).join();
    }
    EXPECT_EQ(sum, 2 * count * 10 * 50);
    return resident_kb();
  };
  const long before = on_new_threads(200), after = on_new_threads(800);
  EXPECT_LT(after - before, 1500);
}

TEST(ParallelDo, RunsEverythingAndRethrowsTheFirstFailureOfTheList) {
  const auto fail = [](const char* what) { throw std::runtime_error(what); };
  for (int repeat = 0; repeat < 50; ++repeat) {
    std::atomic<int> done = 0;
    try {
      parallel_do({[&] { ++done; }, [&] { fail("first"); }, [&] { ++done; },
                   [&] { fail("second"); }, [&] { ++done; }});
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "first");
    }
    EXPECT_EQ(done, 3);
  }
}

TEST(SideBySide, ShowsOneStageThatOnlyGrows) {
  RunContext context;
  std::vector<double> shown;
  context.on_progress([&](const std::string& stage, double fraction) {
    EXPECT_EQ(stage, "all");
    shown.push_back(fraction);
  });
  const auto task = [&] { context.progress("a stage of its own", 0.9); };
  context.side_by_side("all", {task, task, task, task});
  ASSERT_EQ(shown.size(), 5U);
  EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
  EXPECT_EQ(shown.front(), 0);
  EXPECT_EQ(shown.back(), 1);
  context.on_progress([&](const std::string& stage, double) { EXPECT_EQ(stage, "after"); });
  context.progress("after", 0);
}

TEST(SideBySide, TasksCanBeCancelled) {
  RunContext context;
  context.cancel();
  EXPECT_THROW(context.side_by_side("all", {[] {}}), Cancelled);
}

}  // namespace
}  // namespace hydrodip
