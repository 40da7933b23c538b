#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace hydrodip {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInFixedChunks) {
  for (const std::size_t count : {0, 1, 9, 10, 11, 1000}) {
    std::vector<int> visits(count, 0);
    parallel_for(count, 10, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 10, 0U);
      EXPECT_TRUE(end == count || end == begin + 10);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(count, 1));
  }
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

}  // namespace
}  // namespace hydrodip
