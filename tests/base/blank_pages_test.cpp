#include "base/blank_pages.h"

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

TEST(BlankPages, AreZeroAndTakeWhatIsWrittenTo) {
  const double before_mb = resident_mb();
  std::vector<float> values = blank<float>(std::size_t(75) << 20U);  // 315 MB
  ASSERT_EQ(values.size(), std::size_t(75) << 20U);
  for (std::size_t i = 1000000; i < 2000000; ++i) values[i] = float(i);
  for (std::size_t i = 0; i < values.size(); i += 997)
    ASSERT_EQ(values[i], i >= 1000000 && i < 2000000 ? float(i) : 0.0F) << i;
  if (before_mb > 0) {
    EXPECT_LT(resident_mb() - before_mb, 40);
  }
}

TEST(BlankPages, OfAnySizeAreZero) {
  for (const std::size_t size : {0, 1, 4095, 4097, 123457}) {
    const std::vector<std::uint8_t> values = blank<std::uint8_t>(size);
    EXPECT_EQ(values.size(), size);
    EXPECT_EQ(std::count(values.begin(), values.end(), 0), std::ptrdiff_t(size));
  }
}

}  // namespace
}  // namespace hydrodip
