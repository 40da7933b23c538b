#include <gtest/gtest.h>

#include "base/error.h"
#include "calibrate/calibrate.h"

namespace hydrodip {
namespace {

std::vector<double> range(const std::string& text) { return parse_range(text, "--it", 0, 1000); }

TEST(RangeTest, StepsReachTheEnd) {
  EXPECT_EQ(range("0.4:0.6:0.1"), (std::vector<double>{0.4, 0.5, 0.6}));
  EXPECT_EQ(range("0:1:0.3"), (std::vector<double>{0, 0.3, 0.6, 0.9}));
  EXPECT_EQ(range("10:640:x4"), (std::vector<double>{10, 40, 160, 640}));
  EXPECT_EQ(range("1,2.5,600"), (std::vector<double>{1, 2.5, 600}));
  EXPECT_EQ(range("0.65"), (std::vector<double>{0.65}));
  EXPECT_EQ(range("5:5:1"), (std::vector<double>{5}));
}

TEST(RangeTest, RefusesWhatIsNone) {
  for (const char* text : {"", ":", "1:2", "1:2:0", "1:2:-1", "2:1:1", "a", "1:2:x1", "0:2:x2",
                           "1,", "2,1", "1,1", "-1", "0:2000:1000", "0:1:1e-9", "nan", "1:inf:1"})
    EXPECT_THROW(range(text), InputError) << text;
}

}  // namespace
}  // namespace hydrodip
