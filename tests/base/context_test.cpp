#include "base/context.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace hydrodip {
namespace {

TEST(RunContext, CopiesStandForTheSameJob) {
  const RunContext job;
  const RunContext copy = job;
  std::vector<std::string> heard;
  copy.on_log([&](const std::string& line) { heard.push_back(line); });
  copy.on_progress([&](const std::string& activity, double) { heard.push_back(activity); });
  job.log("a line");
  job.progress("an activity", 0.5);
  EXPECT_EQ(heard, (std::vector<std::string>{"a line", "an activity"}));
  job.warn("take care");
  copy.warn("take care");
  EXPECT_EQ(copy.warnings(), std::vector<std::string>{"take care"});
  copy.cancel();
  EXPECT_TRUE(job.cancelled());
  EXPECT_THROW(job.progress("an activity", 1), Cancelled);
  EXPECT_EQ(heard.size(), 2U);
}

TEST(RunContext, JobsDoNotSeeEachOther) {
  const RunContext one, other;
  one.cancel();
  one.warn("take care");
  EXPECT_NO_THROW(other.check_cancelled());
  EXPECT_TRUE(other.warnings().empty());
}

TEST(RunContext, AQuietPartIsCancelledWithItsJobAndKeepsToItself) {
  const RunContext job;
  job.on_progress([](const std::string&, double) { ADD_FAILURE() << "heard"; });
  job.on_log([](const std::string&) { ADD_FAILURE() << "heard"; });
  const RunContext part = job.quiet(), part_of_part = part.quiet(), other = job.quiet();
  part.progress("an activity", 0.5);
  part.log("a line");
  part.warn("take care");
  EXPECT_TRUE(job.warnings().empty());
  part.cancel();
  EXPECT_TRUE(part_of_part.cancelled());
  EXPECT_THROW(part_of_part.check_cancelled(), Cancelled);
  EXPECT_FALSE(job.cancelled());
  EXPECT_FALSE(other.cancelled());
  job.cancel();
  EXPECT_TRUE(other.cancelled());
  EXPECT_THROW(other.progress("an activity", 1), Cancelled);
}

TEST(RunContext, RequestsAreCounted) {
  const RunContext job;
  EXPECT_EQ(job.cancel_requests(), 0);
  job.cancel();
  job.cancel();
  EXPECT_EQ(job.cancel_requests(), 2);
}

TEST(RunContext, TheNthCheckFindsItCancelled) {
  const RunContext job;
  job.cancel_at_check(3);
  job.check_cancelled();
  job.quiet().check_cancelled();  // a part's checks are the job's
  EXPECT_THROW(job.check_cancelled(), Cancelled);
  EXPECT_EQ(job.checks(), 3);
}

TEST(RunScope, LoopsStopBetweenChunksAndTheNextJobDoesNot) {
  for (const int threads : {1, 2, 4}) {
    const RunContext job = RunContext().with_threads(threads);
    std::atomic<int> chunks = 0;
    {
      const RunScope scope(job);
      job.cancel_at_check(5);
      EXPECT_THROW(parallel_for(1000, 1, [&](std::size_t, std::size_t) { ++chunks; }), Cancelled);
      EXPECT_EQ(chunks, 4) << threads << " threads";
      EXPECT_THROW(check_cancelled(), Cancelled);
      {
        const RunContext next;
        const RunScope inner(next);
        EXPECT_NO_THROW(check_cancelled());
      }
      EXPECT_THROW(check_cancelled(), Cancelled);
    }
    EXPECT_NO_THROW(check_cancelled());
  }
}

TEST(RunScope, ReachesThreadsThatTakePart) {
  const RunContext job;
  const RunScope scope(job);
  std::atomic<int> stopped = 0;
  EXPECT_THROW(parallel_for(20, 1,
                            [&](std::size_t, std::size_t) {
                              job.cancel();
                              EXPECT_THROW(check_cancelled(), Cancelled);
                              ++stopped;
                            }),
               Cancelled);
  EXPECT_GT(stopped, 0);
}

TEST(RunScope, LimitsThreadsOfItsJobAlone) {
  const int all = available_threads();
  const RunScope one(RunContext().with_threads(1));
  EXPECT_EQ(available_threads(), 1);
  std::thread([&] { EXPECT_EQ(available_threads(), all); }).join();
  const RunScope more{RunContext()};  // no more than the scope around it
  EXPECT_EQ(available_threads(), 1);
  const std::thread::id here = std::this_thread::get_id();
  parallel_for(100, 1, [&](std::size_t, std::size_t) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    EXPECT_EQ(available_threads(), 1);
  });
}

}  // namespace
}  // namespace hydrodip
