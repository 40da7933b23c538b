#include "object/surface.h"

#include <gtest/gtest.h>

#include "base/parallel.h"

namespace hydrodip {
namespace {

TEST(Surface, LeavesAllThreadsToOthersWhileItLives) {
  const int before = available_threads();
  const Surface surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(available_threads(), before);
}

}  // namespace
}  // namespace hydrodip
