// A loop that says whether it was run as a whole.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "base/parallel.h"

namespace hydrodip::fixtures {

// Every index of a loop in chunks of ten: once, and in the same chunks whoever runs it.
inline void expect_whole_loop(std::size_t count) {
  std::vector<int> visits(count, 0);
  parallel_for(count, 10, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(begin % 10, 0U);
    EXPECT_TRUE(end == count || end == begin + 10);
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  EXPECT_EQ(visits, std::vector<int>(count, 1));
}

}  // namespace hydrodip::fixtures
