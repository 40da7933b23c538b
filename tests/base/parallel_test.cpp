#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "base/whole_loop.h"

namespace hydrodip {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInFixedChunks) {
  for (const std::size_t count : {0, 1, 9, 10, 11, 1000}) fixtures::expect_whole_loop(count);
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
