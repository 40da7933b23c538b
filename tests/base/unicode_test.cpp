#include "base/unicode.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

TEST(CutUtf8, KeepsWholeCharacters) {
  const std::string text = "a\u00e9\u20ac\U0001f3a8z";  // of 1, 2, 3, 4 and 1 bytes
  const std::size_t wholes[] = {0, 1, 1, 3, 3, 3, 6, 6, 6, 6, 10, 11, 11};
  for (std::size_t most = 0; most < std::size(wholes); ++most)
    EXPECT_EQ(cut_utf8(text, most), text.substr(0, wholes[most])) << most;
}

}  // namespace
}  // namespace hydrodip
