#include "base/json_nesting.h"

#include <gtest/gtest.h>

#include <string>

namespace hydrodip {
namespace {

std::string nested(std::size_t deep, char open, char close) {
  return std::string(deep, open) + std::string(deep, close);
}

TEST(JsonNesting, CountsWhatIsOpenAtOnce) {
  EXPECT_FALSE(nests_too_deeply(nested(100, '[', ']')));
  EXPECT_TRUE(nests_too_deeply(nested(101, '[', ']')));
  EXPECT_TRUE(nests_too_deeply(nested(101, '{', '}')));
  std::string side_by_side = "[";
  for (int i = 0; i < 1000; ++i) side_by_side += "[{}],";
  EXPECT_FALSE(nests_too_deeply(side_by_side));
}

TEST(JsonNesting, WhatStandsInQuotesDoesNotCount) {
  EXPECT_FALSE(nests_too_deeply("\"" + std::string(1000, '[') + "\""));
  EXPECT_FALSE(nests_too_deeply("\"\\\"" + std::string(1000, '[') + "\""));
  EXPECT_TRUE(nests_too_deeply("\"\\\\\"" + std::string(1000, '[')));
}

}  // namespace
}  // namespace hydrodip
