#include "base/blank_array.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace hydrodip {
namespace {

double resident_mb() {
  double all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * double(sysconf(_SC_PAGESIZE)) / 1e6;
}

TEST(BlankArray, AreZeroAndTakeWhatIsWrittenTo) {
  [[maybe_unused]] const double before_mb = resident_mb();
  BlankArray<float> values(std::size_t(75) << 20U);  // 315 MB
  ASSERT_EQ(values.size(), std::size_t(75) << 20U);
  for (std::size_t i = 1000000; i < 2000000; ++i) values[i] = float(i);
  for (std::size_t i = 0; i < values.size(); i += 997)
    ASSERT_EQ(values[i], i >= 1000000 && i < 2000000 ? float(i) : 0.0F) << i;
#if !defined(__SANITIZE_THREAD__)  // it keeps books of whatever is looked at
  if (before_mb > 0) {
    EXPECT_LT(resident_mb() - before_mb, 40);
  }
#endif
}

TEST(BlankArray, OfAnySizeAreZero) {
  for (const std::size_t size : {0, 1, 4095, 4097, 123457}) {
    const BlankArray<std::uint8_t> values(size);
    EXPECT_EQ(values.size(), size);
    EXPECT_EQ(std::count(values.begin(), values.end(), 0), std::ptrdiff_t(size));
  }
}

TEST(BlankArray, CopiesAreTheirOwnAndWhatIsMovedIsGone) {
  BlankArray<std::uint16_t> first{1, 2, 3};
  BlankArray<std::uint16_t> copy = first;
  EXPECT_EQ(copy, first);
  copy[1] = 7;
  EXPECT_EQ(first[1], 2);
  EXPECT_FALSE(copy == first);
  EXPECT_FALSE(copy == BlankArray<std::uint16_t>(2));
  const BlankArray<std::uint16_t> moved = std::move(copy);
  EXPECT_TRUE(copy.empty());  // NOLINT(bugprone-use-after-move): that is what is asked
  EXPECT_EQ(moved[1], 7);
  first = moved;
  EXPECT_EQ(first, moved);
  EXPECT_EQ(BlankArray<std::uint16_t>(), BlankArray<std::uint16_t>(0));
}

}  // namespace
}  // namespace hydrodip
