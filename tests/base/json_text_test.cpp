#include "base/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonText, OfAnyBytesIsJson) {
  const Json named = {{"file", "caf\xe9.obj"}, {"good", "café"}};
  for (const std::string& text : {json_text(named), json_line(named)}) {
    const Json read = Json::parse(text, nullptr, false);
    ASSERT_FALSE(read.is_discarded());
    EXPECT_EQ(read["good"], "café");
  }
  EXPECT_EQ(json_text(named).back(), '\n');
  EXPECT_EQ(json_line(named).find('\n'), std::string::npos);
}

TEST(JsonText, AnAnswerSaysFirstWhatItIs) {
  const Json answer = Json::parse(json_answer("rig sheet", {{"file", "a.pdf"}}));
  const Json expected = {{"schema_version", 1}, {"command", "rig sheet"}, {"file", "a.pdf"}};
  EXPECT_EQ(answer.dump(), expected.dump());
}

}  // namespace
}  // namespace hydrodip
