#include "base/json_nesting.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
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

TEST(JsonNesting, WhatNestsTooDeeplyIsDiscardedAsWhatIsNoJson) {
  using Json = nlohmann::json;
  EXPECT_EQ(parsed_json<Json>("[1, {\"a\": 2}]"), Json({1, {{"a", 2}}}));
  EXPECT_TRUE(parsed_json<Json>(nested(101, '[', ']')).is_discarded());
  EXPECT_TRUE(parsed_json<Json>("[1,").is_discarded());
}

}  // namespace
}  // namespace hydrodip
